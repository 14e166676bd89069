// The evaluation: traced pictures against known optics, observers against pictures of known content, the report.
#include "app/evaluate/evaluate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/evaluate/observers.h"
#include "app/evaluate/report.h"
#include "app/exit_code.h"
#include "app/headless/evaluate_command.h"
#include "core/optics/eye.h"
#include "tests/projects/folder.h"

using namespace ilf;
using namespace ilf::app;

namespace {

/// Nine bright discs on black, of `radius` and a third of the picture apart.
Image<float> discs(int size, double radius) {
    std::vector<float> pixels;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double step = size / 3.0;
            const double dx = std::fmod(x + 0.5, step) - 0.5 * step, dy = std::fmod(y + 0.5, step) - 0.5 * step;
            pixels.push_back(std::hypot(dx, dy) < radius ? 1.0F : 0.0F);
        }
    }
    return {{size, size}, 1, std::move(pixels)};
}

/// A ring of `gap` arcmin one metre away, its picture and whether it is read through a lens at `power`.
double shareRead(double gap, double power, double noise) {
    const Metre pitch = Metre::fromSi(0.5 * kArcmin / 60.0);
    RingReader reader({32, 32}, gap / 1.02 / 0.5, noise, 5);
    int right = 0;
    for (int direction = 0; direction < kRingDirections; direction += 2) {
        const auto eye = accommodatedEye(4.0_mm, 20.0_mm, 10.0_D, pitch, 1.0_m, Dioptre::fromSi(power));
        const auto light = picturedRing(eye, {1.0_m, Metre::fromSi(gap * kArcmin), direction},
                                        heldPower(Dioptre::fromSi(power)), {32, 32}, 64);
        for (int i = 0; i < 20; ++i)
            right += reader.read(light) == direction ? 1 : 0;
    }
    return right / 80.0;
}

}  // namespace

TEST_CASE("evaluate: a traced blur circle has the reference's radius") {
    // Reference, camera grid: e = 20 mm, focus at the object, the lens as stop; pixels of 8.4 um.
    const double expected[][3] = {{0.5, 1.0, 23.0415}, {0.7, 2.0, 45.9770}, {0.9, 3.0, 68.8776}};
    for (const auto& [metres, power, radius] : expected) {
        const Metre w = Metre::fromSi(metres);
        const TracedCamera camera = focusedCamera(24.0_mm, 1.4, 8.4_um, w, 20.0_mm, 16.0_mm);
        // Dots so far apart that only the middle one is on the sensor.
        const auto light =
            picturedDots(camera, {w, 400.0_mm, 0.05_mm}, heldPower(Dioptre::fromSi(power)), {200, 200}, 150000);
        const auto circles = blurCircles(exposed(light, 1));
        REQUIRE(circles.size() == 1);
        CHECK(circles.front().radius == doctest::Approx(radius).epsilon(0.015));
        CHECK(circles.front().x == doctest::Approx(100.0).epsilon(0.01));
    }
}

TEST_CASE("evaluate: a lens that moves during the exposure blurs between what it blurs at its ends") {
    const TracedCamera camera = focusedCamera(24.0_mm, 1.4, 8.4_um, 0.5_m, 20.0_mm, 16.0_mm);
    const auto radius = [&](const std::vector<double>& powers) {
        const auto light = picturedDots(camera, {0.5_m, 400.0_mm, 0.05_mm}, powers, {200, 200}, 150000);
        return blurCircles(exposed(light, 2)).at(0).radius;
    };
    const Harmonics ramp{{{2.0, 0.0}, {0.0, -1.0}}};  // 2 D + sin: from 1.2 to 2.8 D over these 30 % of a sweep
    const double moved = radius(sweptPowers(ramp, 0.0, 0.3, 16));
    CHECK(moved > radius(heldPower(1.2_D)) + 3.0);
    CHECK(moved < radius(heldPower(2.8_D)) - 3.0);
}

TEST_CASE("evaluate: circles are fitted to a tenth of a pixel, noise or not") {
    for (const double radius : {4.0, 17.3, 42.6}) {
        const auto circles = blurCircles(exposed(discs(300, radius), 3));
        REQUIRE(circles.size() == 9);
        for (const FittedCircle& circle : circles)
            CHECK(std::abs(circle.radius - radius) < 0.15);
    }
    CHECK(blurCircles(Image<std::uint8_t>({8, 8}, 1, std::vector<std::uint8_t>(64, 0))).empty());
}

TEST_CASE("evaluate: the ring reader reads sharp rings, guesses at tiny ones, and is stopped by blur") {
    CHECK(shareRead(1.0, 0.0, 0.3) > 0.95);  // the eye accommodates
    CHECK(shareRead(1.0, 1.0, 0.3) > 0.95);  // relaxed, in focus
    CHECK(shareRead(0.1, 1.0, 0.3) < 0.45);
    CHECK(shareRead(1.0, 1.7, 0.3) < 0.5);
    CHECK(shareRead(3.0, 1.3, 0.3) > 0.95);  // larger rings survive more blur
}

TEST_CASE("evaluate: detail and light across a border") {
    std::vector<float> sharp, soft;
    for (int i = 0; i < 40 * 10; ++i) {
        const int x = i % 40;
        for (int c = 0; c < 3; ++c) {
            sharp.push_back(x % 2 == 0 ? 1.0F : 0.5F);
            soft.push_back(x < 20 ? 0.75F : x < 23 ? 1.5F : 0.75F);
        }
    }
    const Radiance a({40, 10}, 3, sharp), b({40, 10}, 3, soft);
    CHECK(detailLeft(a, a, 0, 0, 39, 9) == 1.0);
    CHECK(detailLeft(b, a, 0, 0, 19, 9) == 0.0);
    const auto profile = lightAcross(b, a, 2);
    CHECK(weberAt(profile, 20, 5) > 0.5);
    CHECK(std::abs(weberAt(profile, 8, 5)) < 0.35);
}

TEST_CASE("evaluate: a quick run finds what is known") {
    const Folder folder;
    const auto evaluation = evaluated({true});
    REQUIRE(evaluation);
    CHECK(evaluation->sizes.worstModelShare < 0.015);
    CHECK(std::abs(evaluation->sizes.sine.mean) < 0.3);  // the slot lies on the extreme
    CHECK(std::abs(evaluation->sizes.wave.mean) < 3.0);
    // The border falls with 1 / distance, and lies beyond the model's for one arcmin by less than half a dioptre.
    CHECK(evaluation->range.slope == doctest::Approx(1.0).epsilon(0.15));
    for (const BorderCase& one : evaluation->range.cases) {
        const double beyond = one.border_D.mean - 1e3 / one.distance_mm;
        CHECK(beyond > 0.05);
        CHECK(beyond < 0.5);
        CHECK(std::abs(one.border_D.mean - one.steps_D.mean) < 0.3);
    }
    for (const FourObjects& condition : evaluation->objects) {
        for (const ObjectSeen& object : condition.objects)
            CHECK(object.blurred == object.toBlur);
    }
    REQUIRE(evaluation->objects.size() == 2);
    CHECK(evaluation->objects[1].pS_D - evaluation->objects[0].pS_D == doctest::Approx(2.0));
    REQUIRE(evaluation->seams.size() == 12);
    for (const SeamCase& one : evaluation->seams) {
        CHECK((one.before > 0.0) == one.blurredInside);
        CHECK(std::abs(one.after) < std::abs(one.before));
        if (one.texture == "white sheet") CHECK(std::abs(one.after) < 0.06);
    }

    REQUIRE(writeReport(folder.path() / "report", *evaluation));
    for (const char* name :
         {"report.md", "report.json", "blur-size.png", "blur-difference.png", "blur-range.png", "dots.png",
          "objects-1.png", "objects-2.png", "seams-document.png", "seams-picture.png", "seams-white-sheet.png"})
        CHECK(std::filesystem::file_size(folder.path() / "report" / name) > 500);
    const std::string text = printed(*evaluation);
    CHECK(text.find("simulated") != std::string::npos);
    CHECK(text.find("1.4 +- 1.8 px") != std::string::npos);
}

TEST_CASE("evaluate: a folder that cannot be made is refused before any work") {
    const Folder folder;
    std::ofstream(folder.path() / "file") << "x";
    CHECK(evaluateCommand({(folder.path() / "file" / "report").string(), true}) == kFailed);
}
