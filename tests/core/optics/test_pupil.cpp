// Pupil, accommodation and colour against published values, and the laws they keep.
#include "core/optics/pupil.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/optics/accommodation.h"
#include "core/optics/chromatic.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

struct PupilRow {
    double luminance, age, field_deg;
    int eyes;
    double millimetres;
};

/// Of the reference's golden file, which was computed independently.
constexpr PupilRow kRows[] = {
    {0.001, 20, 10, 1, 8.1761218598}, {0.001, 25, 30, 2, 7.78065005843}, {0.001, 75, 10, 2, 5.26455868293},
    {0.1, 30, 30, 2, 6.80695818037},  {0.1, 60, 30, 1, 5.82726202515},   {1, 45, 30, 2, 5.3458867326},
    {10, 25, 10, 2, 5.99676045828},   {10, 60, 30, 2, 3.90246775379},    {100, 20, 30, 1, 4.81706274759},
    {100, 75, 30, 2, 2.88785217202},  {1000, 25, 30, 1, 3.4536929186},   {1000, 45, 10, 2, 3.18897037271},
};

void check(const PupilRow& row) {
    const auto got = pupilInLight({row.luminance, roundField_deg2(row.field_deg), row.eyes}, row.age);
    REQUIRE(got);
    CHECK(std::abs(got->in(1.0_mm) - row.millimetres) < 1e-9);
}

double age() { return 0.1 * *rc::gen::inRange(200, 800); }

}  // namespace

TEST_CASE("pupil: the reference's values") {
    for (const PupilRow& row : kRows)
        check(row);
}

TEST_CASE("pupil: every row of the golden file, where it is at hand") {
    const char* set = std::getenv("IF_GOLDEN");
    const std::filesystem::path folder = set != nullptr
                                             ? std::filesystem::path(set)
                                             : std::filesystem::path(ILF_SOURCE_DIR) / "../shared/reference/golden";
    std::ifstream file(folder / "pupil_watson_yellott.csv");
    if (!file) {
        std::puts("SKIPPED: golden file absent: pupil_watson_yellott.csv (set IF_GOLDEN to its folder)");
        return;
    }
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#' || line[0] == 'L') continue;
        PupilRow row{};
        REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%d,%lf", &row.luminance, &row.age, &row.field_deg, &row.eyes,
                            &row.millimetres) == 5);
        check(row);
        ++rows;
    }
    CHECK(rows > 200);
}

TEST_CASE("pupil: laws") {
    law("more light never widens it", [] {
        const double field = *rc::gen::inRange(1, 5000), dim = 1e-3 * *rc::gen::inRange(0, 1000000);
        const double bright = dim * (1.0 + 0.01 * *rc::gen::inRange(0, 1000)), years = age();
        RC_ASSERT(pupilInLight({bright, field, 2}, years)->si() <= pupilInLight({dim, field, 2}, years)->si());
    });
    law("what counts is light times area, and one eye counts a tenth", [] {
        const double field = *rc::gen::inRange(1, 5000), light = 1e-2 * *rc::gen::inRange(0, 100000), years = age();
        const double one = pupilInLight({light, field, 1}, years)->si();
        const double tenth = pupilInLight({0.1 * light, field, 2}, years)->si();
        const double swapped = pupilInLight({field, light, 1}, years)->si();
        RC_ASSERT(std::abs(one / tenth - 1.0) < 1e-12);
        RC_ASSERT(std::abs(one / swapped - 1.0) < 1e-12);
    });
}

TEST_CASE("pupil: darkness is a luminance; nonsense is refused") {
    CHECK(pupilInLight({0.0, 700.0, 2}, 28.58)->in(1.0_mm) == doctest::Approx(7.75));
    CHECK_FALSE(pupilInLight({-1.0, 700.0, 2}, 30.0));
    CHECK_FALSE(pupilInLight({NAN, 700.0, 2}, 30.0));
    CHECK_FALSE(pupilInLight({10.0, HUGE_VAL, 2}, 30.0));
    CHECK_FALSE(pupilInLight({10.0, 700.0, 3}, 30.0));
    CHECK_FALSE(pupilInLight({10.0, 700.0, 2}, NAN));
}

TEST_CASE("accommodation: Hofstetter's three lines, in order at every age") {
    const AccommodationAmplitude young = accommodationByAge(20.0);
    CHECK(young.least.si() == doctest::Approx(10.0));
    CHECK(young.mean.si() == doctest::Approx(12.5));
    CHECK(young.most.si() == doctest::Approx(17.0));
    CHECK(accommodationByAge(61.0).least == 0.0_D);
    CHECK(accommodationByAge(61.0).most.si() == doctest::Approx(0.6));
    CHECK(accommodationByAge(80.0) == AccommodationAmplitude{});
    CHECK(accommodationAtAge(33.0) == accommodationByAge(33.0).mean);
    law("least <= mean <= most, and none grows with age", [] {
        const double years = 0.1 * *rc::gen::inRange(0, 1000), later = years + 0.1 * *rc::gen::inRange(0, 300);
        const AccommodationAmplitude now = accommodationByAge(years), then = accommodationByAge(later);
        RC_ASSERT(now.least <= now.mean && now.mean <= now.most);
        RC_ASSERT(then.least <= now.least && then.mean <= now.mean && then.most <= now.most);
    });
}

TEST_CASE("colour: refraction by wavelength, zero at 580 nm") {
    const double expected[][2] = {{460e-9, -0.845}, {525e-9, -0.306}, {555e-9, -0.127}, {580e-9, 0.0}, {625e-9, 0.190}};
    for (const auto& [metres, dioptres] : expected)
        CHECK(std::abs(chromaticRefraction(Metre::fromSi(metres))->si() - dioptres) < 1e-3);
    CHECK_FALSE(chromaticRefraction(200e-9_m));
    CHECK_FALSE(chromaticRefraction(Metre::fromSi(NAN)));
}

TEST_CASE("colour: blue light moves the far border nearer by ten times what one arcmin allows") {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    const EyeOptics eye = eyeOptics(wearer);
    const EyeOptics blue = *inLightOf(eye, 460e-9_m), red = *inLightOf(eye, 625e-9_m);
    const double moved = (*minimumBlurPower(blue, 0.5_m) - *minimumBlurPower(eye, 0.5_m)).si();
    // K is not linear: F/(1 + e F) of F = b + Rx against that of b alone.
    const double b = acceptableDefocus(eye).si();
    const double f = b + (*chromaticRefraction(460e-9_m) - *chromaticRefraction(580e-9_m)).si();
    CHECK(moved == doctest::Approx(f / (1.0 + 0.02 * f) - b / (1.0 + 0.02 * b)).epsilon(1e-12));
    CHECK(moved < -10.0 * b);
    CHECK(*minimumBlurPower(red, 0.5_m) > *minimumBlurPower(eye, 0.5_m));
    CHECK(*inLightOf(eye, 580e-9_m) == eye);
    CHECK(inLightOf(*inLightOf(eye, 460e-9_m), 580e-9_m, 460e-9_m)->ametropia.si() == doctest::Approx(0.0));
    CHECK_FALSE(inLightOf(eye, 1.0_m));
}
