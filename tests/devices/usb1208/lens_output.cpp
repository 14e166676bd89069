#include "devices/usb1208/lens_output.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "tests/devices/usb1208/fake_dac.h"

namespace ilf::devices {
namespace {

using test::FakeDac;
using test::FakeDacLink;

Ampere mA(double value) { return Ampere::fromSi(value * 1e-3); }

// 20 mA and -10 mA through the default amplifier: 2.5 V + 10 mV a milliampere, 4096 codes for 5 V.
constexpr std::array<int, 2> kRest{2212, 1966};

LensOutputSetup setup() {
    LensOutputSetup all;
    all.channels.left.rest = mA(20.0);
    all.channels.right.rest = mA(-10.0);
    return all;
}

Waveform driven(double amplitude_mA, Hertz rate = 60.0_Hz) {
    Waveform wave = idealSine(0.0_D, 0.0_D, 2.0_D, rate, 0.0_s);
    wave.unit = DriveUnit::ampere;
    wave.drive.c = {0.0, amplitude_mA * 1e-3};
    return wave;
}

Result<std::unique_ptr<LensOutput>> opened(FakeDac& dac) {
    return LensOutput::open(std::make_shared<FakeDacLink>(dac), setup(), dac.clock());
}

bool rests(const FakeDac& dac) { return !dac.outputRuns && dac.codes == kRest; }
bool says(const Error& error, const std::string& words) { return error.what.find(words) != std::string::npos; }
/// Code of a cosine's sample.
int cosine(double amplitude_mA, std::size_t sample) {
    const double volts = 2.5 + 0.01 * amplitude_mA * std::cos(2.0 * M_PI * static_cast<double>(sample) / 800.0);
    return std::min(4095, static_cast<int>(std::lround(volts * 4096.0 / 5.0)));
}

}  // namespace

TEST_CASE("lens output: opened, both outputs hold rest, whatever ran before") {
    FakeDac dac;
    dac.outputRuns = true;
    const auto output = opened(dac);
    REQUIRE(output);
    CHECK(rests(dac));
    const auto report = (*output)->heartbeat();
    REQUIRE(report);
    CHECK(report->readsBack);
    CHECK_FALSE(report->sweeping);
    CHECK(report->left == mA(20.0));
}

TEST_CASE("lens output: sweeps are played sample for sample, left on AO0 and right on AO1, without a gap") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    const auto change = (*output)->play(driven(200.0), driven(-100.0));
    REQUIRE(change);
    CHECK(change->wait() <= 0.15_s);
    dac.pass(std::chrono::seconds(2));
    CHECK((*output)->heartbeat()->sweeping);
    CHECK_FALSE(dac.underrun);
    CHECK(std::abs(static_cast<double>(dac.played.size()) - 96'000.0) <= 48.0);
    const auto from = static_cast<std::size_t>(change->change.completeAt);
    int worst = 0;
    for (std::size_t i = from; i < dac.played.size(); ++i) {
        worst = std::max(worst, std::abs(dac.played[i][0] - cosine(200.0, i - from)));
        worst = std::max(worst, std::abs(dac.played[i][1] - cosine(-100.0, i - from)));
    }
    CHECK(worst <= 1);
    // From rest into the wave no step is steeper than 1000 A/s: 20.8 mA or 171 codes a sample.
    int steepest = 0;
    for (std::size_t i = 1; i < dac.played.size(); ++i)
        steepest = std::max(steepest, std::abs(dac.played[i][0] - dac.played[i - 1][0]));
    CHECK(steepest <= 172);
    CHECK((*output)->placeOf(static_cast<double>(from) + 5.5)->offset == 5.5);
}

TEST_CASE("lens output: a new wave of the same rate begins where a sweep begins, another rate goes through rest") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    REQUIRE((*output)->play(driven(200.0), driven(200.0)));
    dac.pass(std::chrono::milliseconds(333));
    const auto change = (*output)->play(driven(150.0), driven(150.0));
    REQUIRE(change);
    CHECK(change->change.startsAt % 800 == 0);
    CHECK(change->heardFrom <= change->change.startsAt);
    dac.pass(std::chrono::milliseconds(400));
    const auto at = static_cast<std::size_t>(change->change.completeAt);
    REQUIRE(dac.played.size() > at + 800);
    CHECK(std::abs(dac.played[at + 400][0] - cosine(150.0, 400)) <= 1);
    dac.held.clear();
    REQUIRE((*output)->play(driven(150.0, 50.0_Hz), driven(150.0, 50.0_Hz)));
    CHECK(dac.held.back().second == kRest);
    CHECK(dac.outputRuns);
    dac.pass(std::chrono::milliseconds(500));
    CHECK((*output)->heartbeat());
}

TEST_CASE("lens output: waves that cannot be played are refused and change nothing") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    CHECK((*output)->play(driven(300.0), driven(100.0)).error().fault == Fault::unsafe);
    CHECK(rests(dac));
    CHECK((*output)->slip(1).error().fault == Fault::unsupported);
    REQUIRE((*output)->play(driven(200.0), driven(200.0)));
    dac.pass(std::chrono::milliseconds(300));
    CHECK((*output)->play(driven(300.0), driven(100.0)).error().fault == Fault::unsafe);
    dac.pass(std::chrono::milliseconds(100));
    CHECK(dac.outputRuns);
    CHECK((*output)->heartbeat());
    CHECK((*output)->slip(1));
    CHECK((*output)->shift(30));
}

TEST_CASE("lens output: rest is reached within 100 ms, by a ramp, whether or not the outputs can be read back") {
    for (const bool readsBack : {true, false}) {
        FakeDac dac;
        dac.readsBack = readsBack;
        auto output = opened(dac);
        REQUIRE(output);
        CHECK((*output)->heartbeat()->readsBack == readsBack);
        REQUIRE((*output)->play(driven(240.0), driven(240.0)));
        dac.pass(std::chrono::milliseconds(504));
        const auto before = dac.at;
        dac.held.clear();
        output->reset();
        CHECK(rests(dac));
        CHECK(dac.at - before <= std::chrono::milliseconds(100));
        CHECK(dac.held.size() == 16);
        CHECK(std::abs(dac.held.front().second[0] - kRest[0]) > 50);  // there is a way to go
        // The scan ran on until it was stopped, so steps are judged from the first one held.
        int last = dac.held.front().second[0];
        const int most = std::abs(kRest[0] - last) / 7 + 2;
        for (const auto& [when, codes] : dac.held) {
            CHECK(std::abs(codes[0] - last) <= most);
            last = codes[0];
        }
    }
}

TEST_CASE("lens output: what goes wrong is told, ends in rest, and stays until it is opened again") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    REQUIRE((*output)->play(driven(200.0), driven(200.0)));
    dac.pass(std::chrono::milliseconds(300));
    std::string words;
    SUBCASE("an underrun") {
        dac.starves = true;
        dac.pass(std::chrono::milliseconds(200));
        words = "The DAC ran out of samples";
    }
    SUBCASE("an underrun that only the status shows") {
        dac.underrun = true;
        words = "The DAC ran out of samples";
    }
    SUBCASE("a stream that ends") {
        dac.halted = true;
        words = "the endpoint stalled";
    }
    SUBCASE("a scan that stops by itself") {
        dac.outputRuns = false;
        words = "stopped sweeping the lenses by itself";
    }
    const auto beat = (*output)->heartbeat();
    REQUIRE_FALSE(beat);
    CHECK(says(beat.error(), words));
    CHECK(rests(dac));
    CHECK(says((*output)->play(driven(100.0), driven(100.0)).error(), "Connect it again"));
    CHECK(says((*output)->heartbeat().error(), words));
    CHECK((*output)->safe());
    CHECK(rests(dac));
}

TEST_CASE("lens output: a box that refuses every request and goes on playing is brought to rest by its samples") {
    for (const bool throughError : {true, false}) {
        CAPTURE(throughError);
        FakeDac dac;
        auto output = opened(dac);
        REQUIRE(output);
        REQUIRE((*output)->play(driven(240.0), driven(-240.0)));
        dac.pass(std::chrono::milliseconds(504));
        while (std::abs(dac.codes[0] - kRest[0]) < 1000)  // there is a way to go
            dac.pass(std::chrono::milliseconds(1));
        dac.refuses = true;
        const auto before = dac.at;
        if (throughError)
            CHECK(says((*output)->heartbeat().error(), "the request stalled"));
        else
            CHECK((*output)->safe());
        CHECK(dac.codes == kRest);
        CHECK(dac.at - before <= std::chrono::milliseconds(150));  // what was queued, the buffer and the ramp
        CHECK_FALSE(dac.underrun);
        CHECK(dac.out == nullptr);
        int steepest = 0;
        for (std::size_t i = 1; i < dac.played.size(); ++i)
            steepest = std::max(steepest, std::abs(dac.played[i][0] - dac.played[i - 1][0]));
        CHECK(steepest <= 172);
        // It stays there without any sample, is known to, and obeys once it listens.
        dac.pass(std::chrono::seconds(1));
        CHECK(dac.codes == kRest);
        CHECK((*output)->safe());
        dac.refuses = false;
        CHECK((*output)->safe());
        CHECK(rests(dac));
        if (!throughError) CHECK((*output)->play(driven(240.0), driven(-240.0)));
        dac.pass(std::chrono::milliseconds(300));
        CHECK((*output)->heartbeat().has_value() == !throughError);
    }
}

TEST_CASE("lens output: a box that refuses every request and takes no samples either is not called at rest") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    REQUIRE((*output)->play(driven(240.0), driven(240.0)));
    dac.pass(std::chrono::milliseconds(504));
    dac.refuses = true;
    SUBCASE("whose buffer has played out") {
        dac.starves = true;
        dac.pass(std::chrono::milliseconds(90));
    }
    SUBCASE("whose buffer still lasts") { dac.starves = true; }
    SUBCASE("which has stopped by itself, its buffer full") { dac.outputRuns = false; }
    const auto before = dac.at;
    CHECK_FALSE((*output)->safe());
    CHECK(dac.at - before <= std::chrono::milliseconds(500));
    CHECK(dac.out == nullptr);
}

TEST_CASE("lens output: at rest, outputs that move or run by themselves are noticed") {
    FakeDac dac;
    const auto output = opened(dac);
    REQUIRE(output);
    SUBCASE("moved") {
        dac.codes = {100, 100};
        CHECK(says((*output)->heartbeat().error(), "does not hold the resting currents"));
    }
    SUBCASE("running") {
        dac.outputRuns = true;
        CHECK(says((*output)->heartbeat().error(), "although it was told to hold them"));
    }
    CHECK(rests(dac));
}

TEST_CASE("lens output: samples are made on a thread of their own while waves swap, slip and come to rest") {
    /// A device that takes whatever it is given, as fast as a thread can make it.
    class Greedy final : public FakeDacLink {
    public:
        explicit Greedy(FakeDac& dac) : FakeDacLink(dac) {}
        Result<void> controlOut(const VendorRequest& r, std::span<const std::uint8_t>, Milliseconds) override {
            if (r.request == 0x1A || r.request == 0x1B) runs_ = r.request == 0x1A;
            return {};
        }
        Result<Bytes> controlIn(const VendorRequest& r, std::size_t, Milliseconds) override {
            if (r.request != 0x44) return fail(Fault::device, "the request stalled");
            return Bytes{static_cast<std::uint8_t>(runs_ ? 0x08 : 0x00), 0};
        }
        Result<std::unique_ptr<UsbStream>> streamOut(Endpoint, std::size_t bytes, int,
                                                     std::function<void(std::span<std::uint8_t>)> fill) override {
            struct Stream final : UsbStream {
                std::jthread thread;
                Result<void> state() const override { return {}; }
            };
            auto stream = std::make_unique<Stream>();
            stream->thread = std::jthread([bytes, fill = std::move(fill)](const std::stop_token& stop) {
                Bytes buffer(bytes);
                while (!stop.stop_requested()) {
                    fill(buffer);
                    // Mutexes are not fair: the other thread wants its turn.
                    std::this_thread::sleep_for(std::chrono::microseconds(50));
                }
            });
            return stream;
        }

    private:
        bool runs_ = false;
    };
    FakeDac dac;
    const auto output = LensOutput::open(std::make_shared<Greedy>(dac), setup(), dac.clock());
    REQUIRE(output);
    std::int64_t most = 0;
    for (int round = 0; round < 5; ++round) {
        int swaps = 0;
        for (int i = 0; i < 60; ++i) {
            // While one wave still fades into another, the next is refused.
            if ((*output)->play(driven(50.0 + i % 7 * 20.0), driven(-100.0))) ++swaps;
            REQUIRE((*output)->slip(i % 3 - 1));
            const auto report = (*output)->heartbeat();
            REQUIRE(report);
            CHECK(abs(report->left) <= mA(250.0));
            (*output)->placeOf(static_cast<double>(report->frames));
            most = std::max(most, report->frames);
        }
        // On a busy machine the other thread may not have had a turn yet.
        for (int waits = 0; most == 0 && waits < 20'000; ++waits) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            most = (*output)->heartbeat()->frames;
        }
        CHECK(swaps > 0);  // the first one: from rest
        REQUIRE((*output)->safe());
    }
    CHECK(most > 0);
}

TEST_CASE("lens output: a resting current beyond the amplifier is refused before anything is told") {
    FakeDac dac;
    auto bad = setup();
    bad.channels.right.rest = mA(400.0);
    const auto output = LensOutput::open(std::make_shared<FakeDacLink>(dac), bad, dac.clock());
    CHECK(output.error().fault == Fault::outOfRange);
    CHECK(dac.calls == 0);
}

TEST_CASE("lens output: whichever call fails, there is an error or nothing was lost, and the lenses are at rest") {
    bool restsFirst = false;
    const auto scenario = [&](FakeDac& dac) -> Result<void> {
        auto output = opened(dac);
        if (!output) return tl::unexpected(output.error());
        auto& lenses = **output;
        const auto pass = [&] { dac.pass(std::chrono::milliseconds(250)); };
        return lenses.heartbeat()
            .and_then([&](auto) { return lenses.play(driven(200.0), driven(150.0)); })
            .and_then([&](auto) { return pass(), lenses.heartbeat(); })
            .and_then([&](auto) { return lenses.play(driven(100.0), driven(150.0)); })
            .and_then([&](auto) { return pass(), lenses.heartbeat(); })
            .and_then([&](auto) { return lenses.play(driven(100.0, 50.0_Hz), driven(150.0, 50.0_Hz)); })
            .and_then([&](auto) { return pass(), lenses.heartbeat(); })
            .and_then([&](auto) { return restsFirst ? lenses.safe() : Result<void>(); });
    };
    for (const auto& [forGood, rested] : {std::pair(false, false), std::pair(false, true), std::pair(true, true)}) {
        restsFirst = rested;
        bool passed = false;
        int failing = 1, errors = 0;
        for (; !passed; ++failing) {
            CAPTURE(failing);
            const bool gone = forGood;
            CAPTURE(gone);
            FakeDac dac;
            dac.failsAt = failing;
            dac.goneForGood = forGood;
            const auto result = scenario(dac);
            passed = dac.calls < failing;
            if (!result) ++errors;
            if (passed) CHECK(result);
            // A device that is gone holds what its power-on state is: nothing can be told to it.
            if (!forGood) CHECK(rests(dac));
            if (!result) CHECK_FALSE(result.error().what.empty());
            CHECK(dac.out == nullptr);
        }
        CHECK(failing > 60);
        CHECK(errors > 10);
    }
}

}  // namespace ilf::devices
