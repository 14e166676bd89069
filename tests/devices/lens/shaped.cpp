#include <doctest/doctest.h>

#include "tests/devices/lens/shaped_figure.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

/// Nominal and a few of the variations; the benchmark runs all twenty.
constexpr std::uint64_t kSeeds[] = {0, 1, 2, 3};

void holdsOn(LensPreset preset, const ShapedCase& what) {
    for (const std::uint64_t seed : kSeeds) {
        const auto figure = shapedFigure(preset, seed, what);
        REQUIRE_MESSAGE(figure, word(preset), " ", seed, ": ", figure ? "" : figure.error().what);
        CAPTURE(word(preset));
        CAPTURE(seed);
        CHECK(figure->averaged_D <= allowed_D(preset));
        CHECK(figure->eachSweep_D <= allowed_D(preset) + (preset == LensPreset::dirty ? 0.02 : 0.0));
        CHECK(figure->wave.errors_D.size() <= 5);  // the first play and four iterations
        CHECK(figure->peak_A <= 0.29);
        // The record it kept is the lens, within noise.
        CHECK(std::abs(figure->wave.largestError_D - figure->averaged_D) < 0.02);
    }
}

}  // namespace

TEST_CASE("shaped: every preset is held at 0 and 2.2 D for 30 % of a 60 Hz sweep each") {
    for (const LensPreset preset : kLensPresets)
        holdsOn(preset, {60.0_Hz, 0.30});
}

TEST_CASE("shaped: every preset but dirty is held for 27 % of a 90 Hz sweep") {
    for (const LensPreset preset : kLensPresets) {
        if (preset != LensPreset::dirty) holdsOn(preset, {90.0_Hz, 0.27});
    }
}

TEST_CASE("shaped: twice the light of any sine at the same error") {
    const ShapedCase what;
    for (const LensPreset preset : kLensPresets) {
        CAPTURE(word(preset));
        const double planned = sineDuty(preset, 0, what, 0.05, 0.0), most = sineDuty(preset, 0, what, 0.05, 0.05);
        // arccos(1 - 2 e / swing) / pi = 9.6 % where the lens answers a sine with a sine; a loop flattens the turns.
        CHECK(planned > 0.08);
        CHECK(planned < (preset == LensPreset::dirty ? 0.15 : 0.12));
        CHECK(most > planned);
        CHECK(what.duty > 1.9 * most);
    }
}

TEST_CASE("shaped: a camera's four levels are held for 12 % of the sweep each, which no sine does") {
    const std::array levels{0.0, 0.77, 2.0, 4.0};
    for (const LensPreset preset : kLensPresets) {
        CAPTURE(word(preset));
        LensEmulator lens(lensParameters(preset));
        const auto holds = holdsFor(levels, 0.12, 0.0);
        const auto wave = learnt(recorder(lens), 60.0_Hz, holds, 5, lens.limits());
        REQUIRE_MESSAGE(wave, (wave ? "" : wave.error().what));
        CHECK(largestErrorIn(holds, averageOf(sweepsOf(lens, wave->drive, 60.0_Hz))) < 0.1);
    }
}

TEST_CASE("shaped: what no drive can do is refused before it is played for long") {
    LensEmulator lens(lensParameters(LensPreset::slow));
    const std::array levels{0.0, 8.0};
    const auto wave = learnt(recorder(lens), 180.0_Hz, holdsFor(levels, 0.4, 0.0), 5, lens.limits());
    REQUIRE(!wave);
    CHECK(wave.error().what.find("cannot hold 0 to 8 D at 180 Hz within its drive limits") != std::string::npos);
}
