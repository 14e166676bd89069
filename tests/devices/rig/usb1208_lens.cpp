#include "devices/rig/usb1208_lens.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/devices/usb1208/fake_dac.h"

namespace ilf::devices {
namespace {

/// A box that hears a projector of 60 Hz on AI0 and AO0 on AI1.
struct Box {
    test::FakeDac dac;
    std::unique_ptr<StageLens> lens;

    Box() {
        dac.resolution = std::chrono::nanoseconds(20'833);
        dac.input = [](double t) { return std::fmod(t * 60.0, 1.0) < 0.1 ? 3.3 : 0.0; };
        dac.secondInput = [this](double) { return dac.codes[0] * 5.0 / 4096.0; };
        lens = *Usb1208Lens::open(std::make_shared<test::FakeDacLink>(dac), {}, 0.5_D, dac.clock());
    }
    /// By how many samples AO0's crest comes after the trigger.
    double lag() const {
        double re = 0.0, im = 0.0;
        for (std::size_t i = 0; i < 800; ++i) {
            const double x = 2.0 * M_PI * static_cast<double>(i) / 800.0;
            const double code = dac.played[dac.played.size() - 800 + i][0] - 2048.0;
            re += code * std::cos(x);
            im += code * std::sin(x);
        }
        const double began = std::fmod(dac.seconds() * 60.0, 1.0) * 800.0;
        return std::remainder(std::atan2(im, re) * 800.0 / (2.0 * M_PI) + began, 800.0);
    }
};

}  // namespace

TEST_CASE("lens on a USB-1208: its sweep starts as long after the projector's trigger as the light does") {
    Box box;
    Waveform wave = idealSine(0.5_D, 0.5_D, 2.0_D, 60.0_Hz, 0.0_s);
    wave.unit = DriveUnit::ampere;
    wave.drive.c = {0.0, 0.2};
    REQUIRE(box.lens->play(wave, 1.0_ms));
    Result<PhaseState> phase;
    for (int i = 0; i < 100; ++i) {
        box.dac.pass(std::chrono::milliseconds(30));
        phase = box.lens->follow();
        REQUIRE(phase);
    }
    CHECK(phase->locked);
    CHECK(box.lag() == doctest::Approx(48.0).epsilon(0.08));
    CHECK(box.lens->heartbeat()->sweeping);
    CHECK(box.lens->rest() == 0.5_D);
    REQUIRE(box.lens->safe());
    CHECK_FALSE(box.lens->heartbeat()->sweeping);
    CHECK_FALSE(box.dac.outputRuns);
}

}  // namespace ilf::devices
