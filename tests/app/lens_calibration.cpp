// What the planner gets to know of a lens agrees with what that lens then does.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "app/lens/calibration_of.h"

using namespace ilf;
using namespace ilf::app;
using namespace ilf::devices;

namespace {

WaveWish wish(double low_D, double high_D, Hertz rate) {
    WaveWish out;
    out.low = Dioptre::fromSi(low_D);
    out.high = Dioptre::fromSi(high_D);
    out.levels = {out.low, out.high};
    out.rate = rate;
    return out;
}

/// What the emulator really does with a drive, noise left out.
Harmonics played(LensPreset preset, const Waveform& wave) {
    LensEmulator lens(lensParameters(preset));
    RecordOptions options;
    options.noise_D = 0.0;
    const auto record = recorded(lens, wave.drive, wave.rate, options);
    REQUIRE_MESSAGE(record, record.error().what);
    return harmonicsOf(record->power_D, 16);
}

}  // namespace

TEST_CASE(
    "simulated calibration: on every preset the emulator does what was predicted, and the survey stays in its limits") {
    for (const LensPreset preset : kLensPresets) {
        CAPTURE(std::string(word(preset)));
        const auto calibration = simulatedCalibration(preset, 60.0_Hz);
        REQUIRE_MESSAGE(calibration, calibration.error().what);
        CHECK((*calibration)->lens == "simulated lens, preset " + std::string(word(preset)));
        CHECK((*calibration)->provenance == Provenance::simulated);
        CHECK((*calibration)->limits == LensEmulator(lensParameters(preset)).limits());
        CHECK(std::abs((*calibration)->temperature_C - 30.0) < 0.1);
        REQUIRE((*calibration)->models.size() == 1);
        REQUIRE((*calibration)->tables.size() == 1);
        for (std::size_t i = 0; i < (*calibration)->tables[0].waves.size(); ++i) {
            CHECK((*calibration)->tables[0].low_D[i] >= -10.0);
            CHECK((*calibration)->tables[0].high_D[i] <= 10.0);
        }
        for (const double high : {0.7, 2.27, 4.0, 5.2}) {
            const WaveChoice choice = chosenWave(**calibration, WaveMode::continuous, wish(0.0, high, 60.0_Hz));
            REQUIRE_MESSAGE(choice.wave, choice.why);
            const Harmonics power = played(preset, *choice.wave);
            double worst = 0.0;
            for (int i = 0; i < 100; ++i)
                worst = std::max(worst, std::abs(power.at(i / 100.0) - choice.wave->power.at(i / 100.0)));
            CHECK(worst < (preset == LensPreset::dirty ? 0.15 : 0.02));
        }
        CHECK(*simulatedCalibration(preset, 60.0_Hz) == *calibration);  // kept, not made again
    }
}

TEST_CASE("simulated calibration: other rates are surveyed as far as the lens's drive reaches") {
    for (const Hertz rate : {62.5_Hz, 90.0_Hz, 120.0_Hz}) {
        const auto calibration = simulatedCalibration(LensPreset::slow, rate);
        REQUIRE_MESSAGE(calibration, calibration.error().what);
        const WaveChoice choice = chosenWave(**calibration, WaveMode::continuous, wish(0.0, 2.2, rate));
        REQUIRE_MESSAGE(choice.wave, choice.why);
        CHECK(std::abs(extremes(played(LensPreset::slow, *choice.wave)).high - 2.2) < 0.05);
        CHECK(!chosenWave(**calibration, WaveMode::continuous, wish(0.0, 9.9, rate)).wave);
    }
}

TEST_CASE("a shaped wave is learnt, has an id of its own, and leaves the calibration it was made from as it was") {
    const auto before = simulatedCalibration(LensPreset::datasheet, 60.0_Hz);
    REQUIRE(before);
    const std::array levels{2.2_D, 0.0_D};  // in any order
    const auto after = withShapedWave(*before, LensPreset::datasheet, levels, 0.3, 5, 60.0_Hz);
    REQUIRE_MESSAGE(after, after.error().what);
    CHECK((*before)->shaped.empty());
    REQUIRE((*after)->shaped.size() == 1);
    CHECK((*after)->shaped[0].id > static_cast<std::int64_t>((*before)->tables[0].waves.size()) - 1);
    CHECK((*after)->shaped[0].largestError_D < 0.05);
    const WaveChoice choice = chosenWave(**after, WaveMode::shaped, wish(0.0, 2.2, 60.0_Hz));
    REQUIRE_MESSAGE(choice.wave, choice.why);
    const Harmonics power = played(LensPreset::datasheet, *choice.wave);
    // Both levels are held for 30 % of the sweep somewhere in it.
    for (const double level : {0.0, 2.2}) {
        int held = 0;
        for (int i = 0; i < 1000; ++i)
            held += std::abs(power.at(i / 1000.0) - level) < 0.06 ? 1 : 0;
        CHECK(held >= 290);
    }
    CHECK(!withShapedWave(*before, LensPreset::datasheet, levels, 0.6, 5, 60.0_Hz));
}

TEST_CASE("a file's calibration: tables and models a rate, and of a real lens no drive beyond the recorded") {
    LensBench bench;
    projects::WaveFile waves;
    waves.lens = lensOf(bench);
    auto at60 = surveyed(bench, 60.0_Hz, 30), at90 = surveyed(bench, 90.0_Hz, 9);
    REQUIRE(at60);
    REQUIRE(at90);
    waves.records = *at60;
    waves.records.insert(waves.records.end(), at90->begin(), at90->begin() + 5);
    const auto simulated = calibrationFrom(waves);
    REQUIRE_MESSAGE(simulated, simulated.error().what);
    CHECK((*simulated)->tables.size() == 2);
    CHECK((*simulated)->models.size() == 1);  // five waves are no model
    CHECK((*simulated)->limits == bench.lens().limits());

    waves.lens = {false, "EL-16-40", "A7", "L", ""};
    const auto real = calibrationFrom(waves);
    REQUIRE(real);
    CHECK((*real)->lens == "EL-16-40 A7");
    double peak = 0.0;
    for (const LensRecord& record : waves.records) {
        const Extremes drive = extremes(record.drive);
        peak = std::max({peak, std::abs(drive.low), std::abs(drive.high)});
    }
    CHECK(std::abs((*real)->limits.peak - peak) < 1e-5 * peak);
    CHECK(!benchOf(waves.lens));

    waves.records.clear();
    const auto none = calibrationFrom(waves);
    REQUIRE(!none);
    CHECK(none.error().fault == Fault::notFound);
}

TEST_CASE("the paper's waves: 2485 of them, each between two of 71 voltages") {
    LensBench bench;
    bench.options.settle = 0.0_s;  // what is counted here is drives
    bench.options.periods = 1;
    const auto records = paperWaves(bench, 60.0_Hz);
    REQUIRE_MESSAGE(records, records.error().what);
    CHECK(records->size() == 2485);
    double least = 1.0, most = -1.0;
    for (const LensRecord& record : *records) {
        const Extremes drive = extremes(record.drive);
        least = std::min(least, drive.low);
        most = std::max(most, drive.high);
        const double low = drive.low / 0.002, high = drive.high / 0.002;
        CHECK(std::abs(low - std::round(low)) < 1e-6);
        CHECK(std::abs(high - std::round(high)) < 1e-6);
        CHECK(record.provenance == Provenance::simulated);
    }
    CHECK(std::abs(least + 0.07) < 1e-9);
    CHECK(std::abs(most - 0.07) < 1e-9);
}
