// A USB-1208FS-Plus behind a UsbLink, written from the reference by hand, with a clock that only the test moves.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "devices/clock.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices::test {

struct FakeDac {
    // What it is.
    bool readsBack = true;
    bool deaf = false;                                                 ///< takes requests and does nothing
    bool refuses = false;                                              ///< every request, and takes samples
    bool starves = false;                                              ///< the host no longer fills its transfers
    std::function<double(double)> input = [](double) { return 0.0; };  ///< volts at AI0, by seconds
    std::function<double(double)> secondInput = [](double) { return 0.0; };
    std::vector<std::uint8_t> calibration = std::vector<std::uint8_t>(64, 0);
    std::chrono::nanoseconds resolution{500'000};
    // What it does.
    std::array<int, 2> codes{0, 0};
    bool outputRuns = false, underrun = false, halted = false, inputRuns = false, overrun = false;
    std::uint8_t inputs = 0;
    std::deque<std::uint8_t> fifo;
    double owed = 0.0, inputOwed = 0.0;
    std::int64_t converted = 0;
    std::vector<std::array<int, 2>> played;                   ///< every frame of a scan
    std::vector<std::pair<double, std::array<int, 2>>> held;  ///< every single write: seconds, codes
    std::chrono::nanoseconds at{0};
    // Faults: the n-th call fails, or the device is gone from then on.
    int calls = 0, failsAt = 0;
    bool gone = false, goneForGood = false;

    struct Out {
        std::function<void(std::span<std::uint8_t>)> fill;
        std::size_t bytes = 0;
        std::deque<std::vector<std::uint8_t>> queued;
    };
    struct In {
        std::function<void(std::span<const std::uint8_t>)> taken;
        std::vector<std::uint8_t> gathered;
        std::size_t bytes = 0;
    };
    Out* out = nullptr;
    In* in = nullptr;

    bool failing() {
        ++calls;
        if (failsAt != 0 && calls == failsAt) gone = goneForGood;
        return gone || calls == failsAt;
    }
    double seconds() const { return std::chrono::duration<double>(at).count(); }
    Clock clock() {
        return {[this] { return at; }, [this](std::chrono::nanoseconds time) { pass(time); }};
    }

    void refill() {
        while (out != nullptr && !halted && !out->queued.empty() && fifo.size() + 64 <= 8192) {
            auto& first = out->queued.front();
            const auto packet = static_cast<std::ptrdiff_t>(std::min<std::size_t>(64, first.size()));
            fifo.insert(fifo.end(), first.begin(), first.begin() + packet);
            first.erase(first.begin(), first.begin() + packet);
            if (!first.empty()) continue;
            out->queued.pop_front();
            if (starves) continue;
            out->queued.emplace_back(out->bytes);
            out->fill(out->queued.back());
        }
    }
    void pass(std::chrono::nanoseconds time) {
        // In small steps, as the bus would.
        for (auto left = time; left.count() > 0;) {
            const auto step = std::min(left, resolution);
            left -= step;
            convert(step);
            at += step;
            refill();
            if (outputRuns) {
                owed += std::chrono::duration<double>(step).count() * 48000.0;
                for (; owed >= 1.0; owed -= 1.0)
                    play();
            }
        }
    }
    void play() {
        if (fifo.size() < 4) {
            underrun = true;
            halted = true;
            return;
        }
        std::array<int, 4> b{};
        for (auto& byte : b) {
            byte = fifo.front();
            fifo.pop_front();
        }
        codes = {b[0] + 256 * b[1], b[2] + 256 * b[3]};
        played.push_back(codes);
        refill();
    }
    void convert(std::chrono::nanoseconds step) {
        if (!inputRuns || in == nullptr) return;
        inputOwed += std::chrono::duration<double>(step).count() * 48000.0;
        const int count = (inputs & 1) + (inputs >> 1 & 1);
        for (; inputOwed >= 1.0; inputOwed -= 1.0, ++converted) {
            const double now = inputsSince + static_cast<double>(converted) / 48000.0;
            const bool second = inputs == 2 || (count == 2 && converted % 2 == 1);
            const double volts = second ? secondInput(now) : input(now);
            const int code = std::clamp(static_cast<int>(2048.0 + volts * 204.8 + 0.5), 0, 4095);
            in->gathered.push_back(static_cast<std::uint8_t>(code & 255));
            in->gathered.push_back(static_cast<std::uint8_t>(code >> 8));
            if (in->gathered.size() < in->bytes) continue;
            in->taken(in->gathered);
            in->gathered.clear();
        }
    }
    double inputsSince = 0.0;
};

class FakeDacLink : public UsbLink {
public:
    explicit FakeDacLink(FakeDac& dac) : dac_(dac) {}

    const UsbIdentity& identity() const override { return identity_; }
    Result<Endpoint> interruptOut() const override { return fail(Fault::device, "none"); }
    Result<Endpoint> interruptIn() const override { return fail(Fault::device, "none"); }
    Result<Endpoint> bulkOut() const override {
        if (dac_.failing()) return broken();
        return Endpoint{0x02};
    }
    Result<Endpoint> bulkIn() const override {
        if (dac_.failing()) return broken();
        return Endpoint{0x81};
    }
    Result<void> send(Endpoint, std::span<const std::uint8_t>, Milliseconds) override { return broken(); }
    Result<Bytes> receive(Endpoint, std::size_t, Milliseconds) override { return broken(); }

    Result<void> controlOut(const VendorRequest& r, std::span<const std::uint8_t> data, Milliseconds) override {
        if (dac_.failing()) return broken();
        dac_.pass(std::chrono::microseconds(250));
        if (dac_.refuses) return stalled();
        if (dac_.deaf) return {};
        const auto u32 = [&](std::size_t i) {
            std::uint32_t value = 0;
            for (std::size_t k = 4; k-- > 0;)
                value = value << 8 | data[i + k];
            return value;
        };
        switch (r.request) {
        case 0x18:
            if (dac_.outputRuns || r.index > 1 || r.value > 4095) return stalled();
            dac_.codes[r.index] = r.value;
            dac_.held.emplace_back(dac_.seconds(), dac_.codes);
            return {};
        case 0x1A:
            if (dac_.outputRuns || data.size() != 9 || u32(0) != 0 || u32(4) != 1249 || data[8] != 3) return stalled();
            dac_.refill();
            dac_.outputRuns = true;
            dac_.underrun = false;
            dac_.owed = 0.0;
            return {};
        case 0x1B:
            dac_.outputRuns = false;
            return {};
        case 0x1C:
            dac_.fifo.clear();
            return {};
        case 0x11:
            if (dac_.inputRuns || data.size() != 14 || u32(8) != 1249 || data[13] != 0) return stalled();
            dac_.inputs = data[12];
            dac_.inputRuns = true;
            dac_.converted = 0;
            dac_.inputsSince = dac_.seconds();
            return {};
        case 0x12:
            dac_.inputRuns = false;
            return {};
        case 0x14:
            return data.size() == 8 ? Result<void>() : stalled();
        case 0x15:
            return {};
        default:
            return stalled();
        }
    }
    Result<Bytes> controlIn(const VendorRequest& r, std::size_t length, Milliseconds) override {
        if (dac_.failing()) return broken();
        dac_.pass(std::chrono::microseconds(250));
        if (dac_.refuses) return fail(Fault::device, "the request stalled");
        const auto low = [](int value) { return static_cast<std::uint8_t>(value & 255); };
        const auto high = [](int value) { return static_cast<std::uint8_t>(value >> 8); };
        if (r.request == 0x44 && length == 2) {
            const int bits = (dac_.inputRuns ? 2 : 0) | (dac_.overrun ? 4 : 0) | (dac_.outputRuns ? 8 : 0) |
                             (dac_.underrun ? 16 : 0);
            return Bytes{low(bits), high(bits)};
        }
        if (r.request == 0x18 && length == 4 && dac_.readsBack)
            return Bytes{low(dac_.codes[0]), high(dac_.codes[0]), low(dac_.codes[1]), high(dac_.codes[1])};
        if (r.request == 0x30 && r.value == 0x100 && length == 64) return dac_.calibration;
        return fail(Fault::device, "the request stalled");
    }
    Result<void> clearHalt(Endpoint) override {
        if (dac_.failing()) return broken();
        dac_.halted = false;
        return {};
    }

    class Out final : public UsbStream {
    public:
        Out(FakeDac& dac, std::size_t bytes, std::function<void(std::span<std::uint8_t>)> fill) : dac_(dac) {
            out_.bytes = bytes;
            out_.fill = std::move(fill);
            dac_.out = &out_;
        }
        ~Out() override { dac_.out = nullptr; }
        Result<void> state() const override {
            if (dac_.halted) return fail(Fault::device, "the endpoint stalled");
            if (dac_.gone) return broken();
            return {};
        }
        FakeDac::Out out_;

    private:
        FakeDac& dac_;
    };
    class In final : public UsbStream {
    public:
        In(FakeDac& dac, std::size_t bytes, std::function<void(std::span<const std::uint8_t>)> taken) : dac_(dac) {
            in_.bytes = bytes;
            in_.taken = std::move(taken);
            dac_.in = &in_;
        }
        ~In() override { dac_.in = nullptr; }
        Result<void> state() const override {
            if (dac_.overrun) return fail(Fault::device, "the endpoint stalled");
            if (dac_.gone) return broken();
            return {};
        }

    private:
        FakeDac& dac_;
        FakeDac::In in_;
    };
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t bytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override {
        if (dac_.failing() || to.address != 0x02) return broken();
        auto stream = std::make_unique<Out>(dac_, bytes, std::move(fill));
        for (int i = 0; i < inFlight; ++i) {
            stream->out_.queued.emplace_back(bytes);
            stream->out_.fill(stream->out_.queued.back());
        }
        dac_.refill();
        return stream;
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t bytes, int,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override {
        if (dac_.failing() || from.address != 0x81) return broken();
        return std::make_unique<In>(dac_, bytes, std::move(taken));
    }

private:
    static tl::unexpected<Error> broken() { return fail(Fault::device, "the link failed"); }
    static Result<void> stalled() { return fail(Fault::device, "the request stalled"); }
    FakeDac& dac_;
    UsbIdentity identity_{0x09DB, 0x00E8, "1-2", "USB-1208FS-Plus", "01234567"};
};

}  // namespace ilf::devices::test
