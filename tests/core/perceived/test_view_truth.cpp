// The fast view against rays, option by option. The thresholds are what was measured, less about four decibels.
#include <cmath>

#include "core/perceived/reference.h"
#include "core/perceived/view_engine.h"
#include "tests/core/perceived/small_scene.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

Mask disc(double x, double y, double radius) {
    return maskOf(kSmall, [=](int i, int j) { return std::hypot(i + 0.5 - x, j + 0.5 - y) < radius; });
}
/// A near blurred object before a focused wall.
Document nearBlurred() { return document({region("near", Look::blur, 0.35, disc(70, 60, 30))}, Look::focus, 0.6); }
/// A focused object before a blurred wall.
Document farBlurred() { return document({region("near", Look::focus, 0.4, disc(70, 60, 30))}, Look::blur, 0.9); }

/// PSNR over every second pixel both ways, dB.
double agreement(const Document& document, const ViewRequest& request = {}) {
    const Played p = played(document);
    const Radiance seen = ViewEngine().see(p.document, p.plan, p.program, request)->radiance();
    std::vector<ViewPixel> pixels;
    for (int y = 0; y < seen.height(); y += 2) {
        for (int x = 0; x < seen.width(); x += 2)
            pixels.push_back({x, y});
    }
    const auto rays = Reference::of(p.document, p.plan, p.program, request)->pixels(pixels, {512, 1});
    REQUIRE(rays);
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double d = seen.at(pixels[i].x, pixels[i].y, c) - rays->radiance[i][static_cast<std::size_t>(c)];
            sum += d * d;
        }
    }
    const double dB = -10.0 * std::log10(sum / (3.0 * static_cast<double>(pixels.size())));
    CHECK(rays->noiseFloor_dB > dB + 3.0);
    return dB;
}

}  // namespace

TEST_CASE("perceived truth: each rung") {
    const std::array<Rung, 3> rungs{Rung::dragging, Rung::rest, Rung::idle};
    const std::array<double, 3> before{54.0, 54.0, 54.0}, behind{40.0, 45.0, 48.0};
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        ViewRequest request;
        request.rung = rungs[i];
        CHECK(agreement(nearBlurred(), request) >= before[i]);
        CHECK(agreement(farBlurred(), request) >= behind[i]);
    }
}

TEST_CASE("perceived truth: half size, another attended region, a gaze that stays and one that follows") {
    ViewRequest half, behind, fixed, follows;
    half.scale = 0.5;
    behind.attending = kBackgroundId;
    fixed.gaze = Gaze::fixed;
    fixed.gazeAt = {30.0, 20.0};
    follows.gaze = Gaze::follows;
    CHECK(agreement(nearBlurred(), half) >= 44.0);
    CHECK(agreement(farBlurred(), behind) >= 50.0);
    CHECK(agreement(nearBlurred(), fixed) >= 54.0);
    CHECK(agreement(nearBlurred(), follows) >= 53.0);
}

TEST_CASE("perceived truth: colours, the lens's rim, the room's light, a prescription, a camera") {
    ViewRequest chromatic, rim;
    chromatic.chromatic = true;
    rim.lensField = true;
    Document coloured = nearBlurred(), small = nearBlurred(), lit = nearBlurred(), myope = nearBlurred(),
             camera = nearBlurred();
    coloured.rig.primaries = std::array<Metre, 3>{623e-9_m, 530e-9_m, 460e-9_m};
    small.wearer.lensAperture = 10.0_mm;
    lit.rig.room.ambient_lx = 60.0;
    myope.wearer.ametropia = -2.0_D;
    camera.wearer.camera = CameraObserver{};
    camera.wearer.camera->focusDistance = 0.6_m;
    camera.scene.scale.focalPixels = 200.0;
    CHECK(agreement(coloured, chromatic) >= 42.0);
    CHECK(agreement(small, rim) >= 53.0);
    CHECK(agreement(lit) >= 50.0);
    CHECK(agreement(myope) >= 53.0);
    CHECK(agreement(camera) >= 56.0);
}
