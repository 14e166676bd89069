#include "core/lens/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/core/lens/synthetic_lens.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

LensCalibration calibrated() {
    const SyntheticLens lens;
    LensCalibration out;
    out.lens = "synthetic";
    out.limits.peak = 0.12;
    out.limits.rms = 0.085;
    std::vector<LensRecord> records;
    for (const SineDrive& drive : drivesToRecord(-0.02, 0.045, 40)) {
        const auto id = static_cast<std::int64_t>(records.size()) + 1;
        records.push_back(lens.record(id, drive.offset, drive.amplitude, 60.0_Hz, 0.005));
    }
    out.models.push_back(*fitted(records));
    out.tables.push_back(*waveTable(allWaves(lens, 31, 0.03, 60.0_Hz)));
    ShapedWave shaped;
    shaped.id = 7;
    shaped.holds = {{0.3, 0.3, 0.0}, {0.8, 0.3, 2.2}};
    shaped.drive.c = {0.01, {0.0, -0.008}};
    shaped.power.c = {1.1, {0.0, 1.1}};
    out.shaped.push_back(shaped);
    return out;
}
const LensCalibration& calibration() {
    static const LensCalibration made = calibrated();
    return made;
}

WaveWish wish(double low, double high) {
    WaveWish out;
    out.rest = 0.0_D;
    out.low = Dioptre::fromSi(low);
    out.high = Dioptre::fromSi(high);
    out.levels = {out.low, out.high};
    return out;
}

constexpr WaveMode kFromRecords[] = {WaveMode::paper, WaveMode::slotAware, WaveMode::continuous};

}  // namespace

TEST_CASE("chosen wave: its lowest power falls where slots expect it, and the drive with it") {
    for (const WaveMode mode : {WaveMode::idealSine, WaveMode::paper, WaveMode::slotAware, WaveMode::continuous}) {
        WaveWish asked = wish(0.0, 2.2);
        asked.lowAt = 5.5 / 16.0;
        const WaveChoice choice = chosenWave(calibration(), mode, asked);
        CAPTURE(choice.why);
        REQUIRE(choice.wave);
        CHECK(choice.why.empty());
        CHECK(choice.wave->mode == mode);
        CHECK(choice.wave->low == 0.0_D);
        CHECK(choice.wave->high == 2.2_D);
        // Both extremes lie beside the middles of slots by the same time.
        const Extremes e = extremes(choice.wave->power);
        const double lowOff = 16.0 * (e.atLow - asked.lowAt), highOff = 16.0 * (e.atHigh - asked.lowAt);
        CHECK(std::abs(lowOff) <= 0.25);
        CHECK(highOff - std::round(highOff) == doctest::Approx(-lowOff).epsilon(1e-6));
        if (mode == WaveMode::idealSine) continue;
        // What the lens does with that drive is what is predicted.
        const Harmonics& drive = choice.wave->drive;
        REQUIRE(drive.c.size() == 2);
        const double late = (std::arg(drive.c[1]) / std::numbers::pi + 0.5) / 2.0;
        const Harmonics truth = SyntheticLens{}.power(drive.mean(), std::abs(drive.c[1]), 60.0_Hz).delayed(-late);
        for (int i = 0; i < 32; ++i)
            CHECK(choice.wave->power.at(i / 32.0) == doctest::Approx(truth.at(i / 32.0)).epsilon(0.004));
    }
}

TEST_CASE("chosen wave: the paper's covers the range, the model's slots have the wished means") {
    const WaveChoice paper = chosenWave(calibration(), WaveMode::paper, wish(0.0, 2.2));
    REQUIRE(paper.wave);
    CHECK(paper.wave->wave > 0);
    CHECK(extremes(paper.wave->power).low <= 0.0);
    CHECK(extremes(paper.wave->power).high >= 2.2);

    const WaveChoice model = chosenWave(calibration(), WaveMode::continuous, wish(0.0, 2.2));
    REQUIRE(model.wave);
    const Extremes e = extremes(model.wave->power);
    CHECK(model.wave->power.meanOver(e.atLow - 1.0 / 32.0, 1.0 / 16.0) == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(model.wave->power.meanOver(e.atHigh - 1.0 / 32.0, 1.0 / 16.0) == doctest::Approx(2.2).epsilon(1e-9));
}

TEST_CASE("chosen wave: what is called reachable is, and a milli-dioptre more is not") {
    law("reachable", [] {
        LensCalibration lens = calibration();
        const WaveMode mode = *rc::gen::elementOf(std::vector(std::begin(kFromRecords), std::end(kFromRecords)));
        const double low = 0.001 * *rc::gen::inRange(-1500, 1500);
        lens.temperature_C = 30.0 + *rc::gen::inRange(-10, 10);
        lens.limits.lensMax = Dioptre::fromSi(0.1 * *rc::gen::inRange(20, 100));
        lens.limits.peak = 0.001 * *rc::gen::inRange(15, 60);
        lens.limits.rms = 0.7 * lens.limits.peak;
        const WaveChoice far = chosenWave(lens, mode, wish(low, low + 30.0));
        RC_ASSERT(!far.wave.has_value());
        RC_ASSERT(!far.why.empty());
        const double reach = far.reachable.si();
        RC_PRE(reach > low + 0.01);
        const WaveChoice at = chosenWave(lens, mode, wish(low, reach - (mode == WaveMode::continuous ? 1e-3 : 0.0)));
        RC_ASSERT(at.wave.has_value());
        RC_ASSERT(std::abs(at.reachable.si() - reach) < 1e-3);
        const WaveChoice beyond = chosenWave(lens, mode, wish(low, reach + 1e-3));
        RC_ASSERT(!beyond.wave.has_value());
        RC_ASSERT(std::abs(beyond.reachable.si() - reach) < 1e-3);
    });
}

TEST_CASE("chosen wave: nothing exceeds the limits") {
    law("limits", [] {
        LensCalibration lens = calibration();
        const WaveMode mode = *rc::gen::elementOf(std::vector(std::begin(kFromRecords), std::end(kFromRecords)));
        lens.limits.peak = 0.001 * *rc::gen::inRange(10, 40);
        lens.limits.rms = 0.001 * *rc::gen::inRange(10, 30);
        lens.limits.lensMax = Dioptre::fromSi(0.1 * *rc::gen::inRange(20, 60));
        lens.limits.lensMin = Dioptre::fromSi(-0.1 * *rc::gen::inRange(5, 20));
        const double low = 0.001 * *rc::gen::inRange(-500, 1000), high = low + 0.001 * *rc::gen::inRange(10, 2000);
        const WaveChoice choice = chosenWave(lens, mode, wish(low, high));
        RC_ASSERT(choice.wave.has_value() == choice.why.empty());
        RC_PRE(choice.wave.has_value());
        const Extremes drive = extremes(choice.wave->drive), power = extremes(choice.wave->power);
        RC_ASSERT(std::max(-drive.low, drive.high) <= lens.limits.peak * (1.0 + 1e-12));
        RC_ASSERT(choice.wave->drive.rms() <= lens.limits.rms * (1.0 + 1e-12));
        RC_ASSERT(power.low >= lens.limits.lensMin.si() - 1e-9);
        RC_ASSERT(power.high <= lens.limits.lensMax.si() + 1e-9);
    });
}

TEST_CASE("chosen wave: a warmer lens gets less drive for the same powers") {
    LensCalibration warm = calibration();
    warm.temperature_C = 35.0;
    const WaveChoice now = chosenWave(warm, WaveMode::continuous, wish(0.0, 2.2));
    const WaveChoice cool = chosenWave(calibration(), WaveMode::continuous, wish(0.0, 2.2));
    REQUIRE(now.wave);
    REQUIRE(cool.wave);
    CHECK(now.wave->drive.mean() < cool.wave->drive.mean());
    CHECK(now.wave->power.meanOver(0.0, 1.0 / 16.0) == doctest::Approx(0.0).epsilon(1e-4));
    // 5 degrees, 0.033 D each.
    const Harmonics at30 = calibration().models[0].power(now.wave->drive.mean(), std::abs(now.wave->drive.c[1]));
    CHECK(now.wave->power.mean() - at30.mean() == doctest::Approx(0.165));

    const WaveChoice paper = chosenWave(warm, WaveMode::paper, wish(0.0, 2.2));
    REQUIRE(paper.wave);
    CHECK(extremes(paper.wave->power).low <= 0.0);
    CHECK(extremes(paper.wave->power).high >= 2.2);
}

TEST_CASE("chosen wave: of two tables of a rate the one recorded nearest to the temperature now is used") {
    LensCalibration lens = calibration();
    lens.tables.push_back(lens.tables[0]);
    lens.tables[1].temperature_C = 40.0;
    for (TableWave& wave : lens.tables[1].waves)
        wave.id += 10000;
    lens.temperature_C = 33.0;
    CHECK(chosenWave(lens, WaveMode::paper, wish(0.0, 2.2)).wave->wave < 10000);
    lens.temperature_C = 37.0;
    CHECK(chosenWave(lens, WaveMode::paper, wish(0.0, 2.2)).wave->wave > 10000);
}

TEST_CASE("chosen wave: shaped waves are found by the levels they hold") {
    const WaveChoice found = chosenWave(calibration(), WaveMode::shaped, wish(0.0, 2.2));
    REQUIRE(found.wave);
    CHECK(found.wave->wave == 7);
    CHECK(found.reachable == 2.2_D);
    // The hold of the lowest level, recorded about 0.3, lies about lowAt.
    CHECK(found.wave->power.at(0.5 / 16.0) == doctest::Approx(calibration().shaped[0].power.at(0.3)));

    CHECK(chosenWave(calibration(), WaveMode::shaped, wish(0.015, 2.185)).wave);
    CHECK_FALSE(chosenWave(calibration(), WaveMode::shaped, wish(0.0, 2.25)).wave);
    WaveWish three = wish(0.0, 2.2);
    three.levels = {0.0_D, 1.1_D, 2.2_D};
    const WaveChoice none = chosenWave(calibration(), WaveMode::shaped, three);
    CHECK_FALSE(none.wave);
    CHECK(none.why ==
          "No shaped wave for 0, 1.1, 2.2 D at 60 Hz has been learnt: learn one, or choose the continuous mode.");
    CHECK(none.reachable == 2.2_D);

    LensCalibration again = calibration();
    again.shaped.push_back(again.shaped[0]);
    again.shaped.back().id = 8;
    CHECK(chosenWave(again, WaveMode::shaped, wish(0.0, 2.2)).wave->wave == 8);
    again.temperature_C = 32.0;
    CHECK(chosenWave(again, WaveMode::shaped, wish(0.0, 2.2)).why ==
          "The lens is at 32 degrees C now, and the shaped wave for 0, 2.2 D was learnt at another temperature: learn "
          "it again.");
}

TEST_CASE("chosen wave: a rate that was never recorded is refused with the rates that were") {
    WaveWish asked = wish(0.0, 2.2);
    asked.rate = 90.0_Hz;
    CHECK(chosenWave(calibration(), WaveMode::paper, asked).why ==
          "There are no recorded waves at 90 Hz: record the lens at this rate, or sweep at one that was recorded (60 "
          "Hz).");
    CHECK(chosenWave(calibration(), WaveMode::continuous, asked).why ==
          "There is no model of the lens at 90 Hz: record the lens at this rate, or sweep at one that was recorded (60 "
          "Hz).");
    CHECK(chosenWave({}, WaveMode::paper, wish(0.0, 2.2)).why ==
          "There are no recorded waves at 60 Hz: record the lens at this rate.");
    CHECK_FALSE(chosenWave(calibration(), WaveMode::shaped, asked).wave);
}

TEST_CASE("chosen wave: a still lens needs no record") {
    for (const WaveMode mode : {WaveMode::paper, WaveMode::slotAware, WaveMode::continuous, WaveMode::shaped}) {
        const WaveChoice choice = chosenWave({}, mode, wish(0.5, 0.5));
        REQUIRE(choice.wave);
        CHECK(choice.wave->still());
        CHECK(choice.wave->drive.c.empty());
        CHECK(choice.wave->power.mean() == 0.5);
    }
    CHECK_FALSE(chosenWave({}, WaveMode::paper, wish(11.0, 11.0)).wave);
}

TEST_CASE("chosen wave: wishes that are no sweep are refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [low, high] : {std::pair(nan, 1.0), std::pair(0.0, nan), std::pair(2.0, 1.0)})
        CHECK_FALSE(chosenWave(calibration(), WaveMode::continuous, wish(low, high)).wave);
    WaveWish asked = wish(0.0, 1.0);
    asked.rate = 0.0_Hz;
    CHECK_FALSE(chosenWave(calibration(), WaveMode::idealSine, asked).wave);
}

TEST_CASE("chosen wave: an uncovered range says how far the records go") {
    const WaveChoice none = chosenWave(calibration(), WaveMode::paper, wish(0.0, 9.9));
    CHECK_FALSE(none.wave);
    CHECK(none.why.find("None of the 465 recorded waves at 60 Hz covers 0 to 9.9 D") == 0);
    CHECK(none.reachable > 2.2_D);
    CHECK(none.reachable < 9.9_D);
}
