// How many random messages a test gives to a decoder: a fixed number, or for as long as somebody asks by hand.
#pragma once

#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace ilf {

/// `for (Fuzz fuzz; fuzz.goesOn();)`: 100 000 messages from a fixed seed. With ILF_FUZZ_SECONDS in the environment as
/// many as there is time for, from a seed of its own (or ILF_FUZZ_SEED, to see again what was seen); both are said at
/// the end, also where a check has thrown.
class Fuzz {
public:
    explicit Fuzz(long usually = 100'000) : usually_(usually) {
        const char* seconds = std::getenv("ILF_FUZZ_SECONDS");
        const char* seed = std::getenv("ILF_FUZZ_SEED");
        if (seconds != nullptr) until_ = Clock::now() + std::chrono::seconds(std::atol(seconds));
        seed_ = seed != nullptr ? static_cast<std::uint32_t>(std::strtoul(seed, nullptr, 10))
                : byHand()      ? std::random_device{}()
                                : 20260101U;
        random_.seed(seed_);
    }
    ~Fuzz() {
        if (byHand()) MESSAGE(count_, " messages, seed ", seed_);
    }
    Fuzz(const Fuzz&) = delete;
    Fuzz& operator=(const Fuzz&) = delete;

    bool goesOn() {
        const bool more = byHand() ? count_ % 64 != 0 || Clock::now() < until_ : count_ < usually_;
        count_ += more ? 1 : 0;
        return more;
    }
    /// Of the message that is due: 0, 1, ...
    long number() const { return count_ - 1; }
    std::uint32_t below(std::size_t bound) { return static_cast<std::uint32_t>(random_() % bound); }
    template <class Byte = std::uint8_t>
    Byte byte() {
        return static_cast<Byte>(random_());
    }
    /// Noise of any length below `bound`.
    template <class Byte = std::uint8_t>
    std::vector<Byte> bytes(std::size_t bound) {
        std::vector<Byte> made(below(bound));
        for (Byte& one : made)
            one = byte<Byte>();
        return made;
    }
    /// One to four bytes are others; one in three is cut as well.
    template <class Bytes>
    void damage(Bytes& whole) {
        if (whole.empty()) return;
        for (auto n = 1 + below(4); n > 0; --n)
            whole[below(whole.size())] = byte<typename Bytes::value_type>();
        if (below(3) == 0) whole.resize(below(whole.size()));
    }

private:
    using Clock = std::chrono::steady_clock;
    bool byHand() const { return until_ != Clock::time_point{}; }

    long usually_, count_ = 0;
    Clock::time_point until_;
    std::uint32_t seed_;
    std::mt19937 random_;
};

}  // namespace ilf
