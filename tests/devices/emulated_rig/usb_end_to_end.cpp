// Intended against received light in real time: the stage that plays on hardware, over libusb and an X server, against
// an emulated rig that knows nothing but what came over its cables. Needs libumockdev-preload.so.0 in LD_PRELOAD, as
// ctest sets it, and Xvfb; says so where one is missing.
#include <doctest/doctest.h>

#include "core/lens/waveform.h"
#include "tests/devices/emulated_rig/running_rig.h"
#include "tests/devices/endtoend/bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using namespace std::chrono_literals;

namespace {

/// A sine of +-100 mA: some 6 D either way, which a lens follows as it can.
Waveform driven() {
    Waveform wave = idealSine(0.5_D, -2.0_D, 3.0_D, 60.0_Hz, 0.0_s);
    wave.unit = DriveUnit::ampere;
    wave.drive.c = {0.0, 0.1};
    return wave;
}

Program playing(int slots, std::uint32_t seed) {
    Program program = sweepOf(slots, seed);
    program.waveform = driven();
    program.projectorDelay = {};
    return program;
}

/// As intended, looked at until it is or two seconds have gone: a picture takes some frames from a window to light.
LightComparison lightOf(RunningRig& rig, const Program& program, int bits, Received& received) {
    LightComparison found;
    const auto until = std::chrono::steady_clock::now() + 2s;
    do {
        found = compared(intendedSweep(program, bits), receivedSweep(rig.client(), received));
    } while (!found.same() && std::chrono::steady_clock::now() < until);
    return found;
}

/// Loads and swaps. A machine that is too busy to keep samples coming ends in safe light, as it should: then it is
/// taken again, aloud, three times in all.
Result<void> played(Stage& stage, const Program& program) {
    for (int once = 1;; ++once) {
        const auto swapped = stage.load(program).and_then([&] { return stage.swap(); });
        if (swapped || once == 3 || swapped.error().what.find("too busy") == std::string::npos) return swapped;
        MESSAGE("taken again: ", swapped.error().what);
    }
}

}  // namespace

TEST_CASE("emulated rig: what the stage plays arrives as light to the last pixel, and the lenses swing in step") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    for (const auto& [slots, bits] : {std::pair(2, 8), std::pair(6, 4)}) {
        CAPTURE(bits);
        const auto stage = rig.stage(bits);
        for (std::uint32_t seed = 70; seed < 72; ++seed) {
            const Program program = playing(slots, seed);
            const auto swapped = played(*stage, program);
            if (!swapped) FAIL(swapped.error().what);
            Received received;
            const auto found = lightOf(rig, program, bits, received);
            MESSAGE(verdict(found));
            CHECK(found.same());
            CHECK(found.differingPixels == 0);
            CHECK(abs(found.offset) < 0.1_ms);
            CHECK(received.patterns);
            CHECK_FALSE(received.harmed);
            CHECK(received.ledCurrentWrites == 0);
            CHECK(received.exposures.size() == static_cast<std::size_t>(slots));
            CHECK(received.sweep.si() == doctest::Approx(1.0 / 60.0).epsilon(1e-3));
            CHECK(received.most_mA[0] == doctest::Approx(100.0).epsilon(0.03));
            CHECK(received.most_mA[1] == doctest::Approx(100.0).epsilon(0.03));
            const auto [low, high] = std::ranges::minmax(received.left);
            CHECK(high - low > 3.0_D);
        }
        const auto trouble = playedFor(*stage, 2s);
        if (trouble) FAIL(*trouble);
        REQUIRE(stage->report().timing);
        CHECK(stage->report().timing->locked);
        CHECK(stage->report().timing->phase < 0.3_ms);
        stage->safeLight();
    }
}
