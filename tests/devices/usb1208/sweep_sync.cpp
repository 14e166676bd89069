#include "devices/usb1208/sweep_sync.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "tests/devices/usb1208/fake_dac.h"

namespace ilf::devices {
namespace {

using test::FakeDac;
using test::FakeDacLink;

Waveform driven(double amplitude_mA) {
    Waveform wave = idealSine(0.0_D, 0.0_D, 2.0_D, 60.0_Hz, 0.0_s);
    wave.unit = DriveUnit::ampere;
    wave.drive.c = {0.0, amplitude_mA * 1e-3};
    return wave;
}

/// A box whose AI0 hears a projector and whose AI1 hears AO0. Everything behind one virtual clock.
struct Rig {
    FakeDac dac;
    double projector_Hz = 60.0, firstTrigger_s = 0.0071;
    bool triggers = true, wired = true;
    double skipsAt = 1e9;  ///< when the device loses half a sweep of its buffer
    std::shared_ptr<FakeDacLink> link = std::make_shared<FakeDacLink>(dac);
    std::unique_ptr<LensOutput> output;
    std::unique_ptr<AnalogInput> input;
    std::unique_ptr<SweepSync> sync;

    /// 1 ms pulses of 3.3 V whose edges take 60 us, as behind a filter.
    double trigger(double t) const {
        const double since = std::remainder((t - firstTrigger_s) * projector_Hz, 1.0) / projector_Hz;
        if (!triggers) return 0.0;
        return 3.3 * std::clamp(std::min(since / 60e-6 + 0.5, (1e-3 - since) / 60e-6 + 0.5), 0.0, 1.0);
    }
    void start() {
        dac.resolution = std::chrono::nanoseconds(20'833);
        dac.input = [this](double t) { return trigger(t); };
        dac.secondInput = [this](double) { return wired ? dac.codes[0] * 5.0 / 4096.0 : 0.0; };
        output = *LensOutput::open(link, {}, dac.clock());
        REQUIRE(output->play(driven(200.0), driven(-150.0)));
        dac.pass(std::chrono::milliseconds(7));
        input = *AnalogInput::start(link, Hearing::triggerAndAI1, dac.clock());
        sync = std::make_unique<SweepSync>(*output, *input, Echo::leftOutput, EdgeLevels{}, 0.0, dac.clock());
    }
    Result<SyncReport> run(double seconds) {
        Result<SyncReport> last;
        for (int i = 0; i < static_cast<int>(seconds / 0.04); ++i) {
            dac.pass(std::chrono::milliseconds(40));
            last = sync->step();
            if (!last) break;
        }
        return last;
    }
    /// By how many samples AO0's wave comes after the projector's trigger, from the codes that were really played.
    double phase() const {
        const double now = dac.seconds();
        const double triggerAgo = std::fmod((now - firstTrigger_s) * projector_Hz, 1.0) * 48000.0 / projector_Hz;
        double re = 0.0, im = 0.0;
        for (std::size_t i = 0; i < 1600; ++i) {
            const double x = 2.0 * M_PI * static_cast<double>(i) / 800.0;
            const double code = dac.played[dac.played.size() - 1600 + i][0] - 2048.0;
            re += code * std::cos(x);
            im += code * std::sin(x);
        }
        // The cosine's crest is `lag` samples after the window began, which was 1600 samples ago.
        const double lag = std::atan2(im, re) * 800.0 / (2.0 * M_PI);
        return std::remainder(lag + triggerAgo, 800.0);
    }
};

}  // namespace

TEST_CASE("sweep sync: from trigger and echo the wave really played comes to stand on the projector's trigger") {
    for (const double ppm : {-80.0, 60.0}) {
        Rig rig;
        rig.projector_Hz = 60.0 * (1.0 + ppm * 1e-6);
        rig.start();
        const auto report = rig.run(3.0);
        REQUIRE(report);
        CHECK(report->placeKnown);
        CHECK(report->phase.locked);
        CHECK(std::abs(report->phase.driftPpm + ppm) < 20.0);
        for (int i = 0; i < 10; ++i) {
            REQUIRE(rig.run(0.2));
            CHECK(std::abs(rig.phase()) <= 3.0);
        }
        // Another wave of the same rate keeps the lock.
        REQUIRE(rig.output->play(driven(120.0), driven(100.0)));
        const auto after = rig.run(1.0);
        REQUIRE(after);
        CHECK(after->phase.locked);
        CHECK(std::abs(rig.phase()) <= 3.0);
        CHECK_FALSE(rig.dac.underrun);
    }
}

TEST_CASE("sweep sync: what breaks the lock is told in words") {
    Rig rig;
    const auto says = [](const Result<SyncReport>& result, const std::string& words) {
        return !result && result.error().what.find(words) != std::string::npos;
    };
    SUBCASE("no trigger at all") {
        rig.triggers = false;
        rig.start();
        CHECK(says(rig.run(2.0), "No trigger comes from the projector"));
    }
    SUBCASE("the trigger is pulled out") {
        rig.start();
        REQUIRE(rig.run(2.0));
        rig.triggers = false;
        CHECK(says(rig.run(0.5), "The projector's trigger is lost"));
    }
    SUBCASE("59.94 Hz") {
        rig.projector_Hz = 60.0 / 1.001;
        rig.start();
        CHECK(says(rig.run(2.0), "not 59.94"));
    }
    SUBCASE("the echo's wire is missing") {
        rig.wired = false;
        rig.start();
        CHECK(says(rig.run(2.0), "wire from AO0 to AI1"));
    }
    SUBCASE("the device loses samples of the output") {
        rig.start();
        REQUIRE(rig.run(2.0));
        rig.dac.fifo.erase(rig.dac.fifo.begin(), rig.dac.fifo.begin() + 400);
        CHECK(says(rig.run(1.0), "the DAC lost samples"));
    }
    SUBCASE("the input stops") {
        rig.start();
        REQUIRE(rig.run(1.0));
        rig.dac.inputRuns = false;
        CHECK(says(rig.run(1.0), "stopped listening"));
    }
    SUBCASE("the input loses samples") {
        rig.start();
        rig.dac.overrun = true;
        CHECK(says(rig.run(1.0), "lost samples of the trigger"));
    }
}

TEST_CASE("analog input: volts of both channels come in order, and nobody listening is noticed") {
    FakeDac dac;
    dac.input = [](double t) { return t < 0.5 ? 1.0 : 3.0; };
    dac.secondInput = [](double) { return -2.0; };
    auto link = std::make_shared<FakeDacLink>(dac);
    auto input = AnalogInput::start(link, Hearing::triggerAndAI1, dac.clock());
    REQUIRE(input);
    CHECK_FALSE((*input)->factoryCalibrated());
    CHECK((*input)->samplesPerSecond() == 24'000.0);
    std::int64_t next = 0;
    for (int i = 0; i < 20; ++i) {
        dac.pass(std::chrono::milliseconds(17));
        const auto block = (*input)->take();
        REQUIRE(block);
        CHECK(block->firstSample == next);
        CHECK(block->trigger.size() == block->second.size());
        next += static_cast<std::int64_t>(block->trigger.size());
        for (const double volts : block->trigger)
            CHECK(volts == doctest::Approx(1.0).epsilon(0.005));
        for (const double volts : block->second)
            CHECK(volts == doctest::Approx(-2.0).epsilon(0.005));
    }
    CHECK(std::abs(static_cast<double>(next) - 0.34 * 24'000.0) < 300.0);
    dac.pass(std::chrono::seconds(11));
    CHECK((*input)->take().error().what.find("Nobody listened") == 0);
    input->reset();
    CHECK_FALSE(dac.inputRuns);
    CHECK(dac.in == nullptr);
}

TEST_CASE("analog input: whichever call fails, it is told or does no harm, and the input is stopped") {
    for (int failing = 1;; ++failing) {
        CAPTURE(failing);
        FakeDac dac;
        dac.failsAt = failing;
        {
            auto input = AnalogInput::start(std::make_shared<FakeDacLink>(dac), Hearing::trigger, dac.clock());
            if (input) {
                dac.pass(std::chrono::milliseconds(50));
                CHECK((*input)->take());
            } else {
                CHECK_FALSE(input.error().what.empty());
            }
        }
        CHECK(dac.in == nullptr);
        CHECK_FALSE(dac.inputRuns);
        if (dac.calls < failing) {
            CHECK(failing > 8);
            break;
        }
    }
}

}  // namespace ilf::devices
