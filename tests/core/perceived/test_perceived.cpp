// The perceived view against rays through the pupil, and what must not change.
#include "core/perceived/perceived.h"

#include <cmath>

#include "tests/core/perceived/small_scene.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

constexpr int kRays = 120;

Mask disc(double x, double y, double radius) {
    return maskOf(kSmall, [=](int i, int j) { return std::hypot(i + 0.5 - x, j + 0.5 - y) < radius; });
}
Mask leftOf(int x) {
    return maskOf(kSmall, [=](int i, int) { return i < x; });
}

/// Focus and blur side by side on one surface.
Played onePlane() {
    Document d = document({region("left", Look::focus, 0.5, leftOf(70))}, Look::blur, 0.5);
    d.scene.scale.focalPixels = 800.0;
    return played(d);
}
/// A near blurred object before a focused one.
Played nearBlurred() {
    return played(document({region("near", Look::blur, 0.35, disc(70, 60, 30))}, Look::focus, 0.6));
}
/// A focused object before a blurred wall.
Played farBlurred() { return played(document({region("near", Look::focus, 0.4, disc(70, 60, 30))}, Look::blur, 0.9)); }
/// All blurred, at three distances.
Played allBlurred() {
    return played(
        document({region("a", Look::blur, 0.35, disc(50, 60, 25)), region("b", Look::blur, 0.5, disc(100, 50, 30))},
                 Look::blur, 0.8));
}

Radiance fast(const Played& p, const ViewRequest& request = {}) {
    return *perceived(p.document, p.plan, p.program, request);
}
Radiance byRays(const Played& p, const ViewRequest& request = {}, int rays = kRays) {
    return *perceivedReference(p.document, p.plan, p.program, request, rays, 1);
}
double agreement(const Played& p, const ViewRequest& request = {}) {
    return psnr(fast(p, request), byRays(p, request));
}

}  // namespace

TEST_CASE("perceived: agrees with rays on one surface, and would not with a radius or scale 5 % off") {
    const Played scene = onePlane();
    const Radiance rays = byRays(scene, {}, 600);
    const double right = psnr(fast(scene), rays);
    MESSAGE("one surface: ", right, " dB");
    CHECK(right >= 55.0);

    Played wider = scene;
    wider.plan.input.eye.pupil = 1.05 * scene.plan.input.eye.pupil;
    MESSAGE("radius 5 % off: ", psnr(fast(wider), rays), " dB");
    CHECK(psnr(fast(wider), rays) < 50.0);
    Played farther = scene;
    farther.plan.input.eye.lensToPupil = 1.05 * scene.plan.input.eye.lensToPupil;
    MESSAGE("magnification 5 % off: ", psnr(fast(farther), rays), " dB");
    CHECK(psnr(fast(farther), rays) < 50.0);
}

TEST_CASE("perceived: agrees with rays where surfaces hide each other") {
    for (const auto& [name, scene] : {std::pair("near blurred", nearBlurred()), std::pair("far blurred", farBlurred()),
                                      std::pair("all blurred", allBlurred())}) {
        const double left = agreement(scene), right = agreement(scene, {Eye::right, {}, 1.0});
        MESSAGE(name, ": ", left, " dB, ", right, " dB");
        CHECK(left >= 40.0);
        CHECK(right >= 40.0);
    }
}

TEST_CASE("perceived: agrees with rays at half size, for another attended region, and for a camera") {
    CHECK(agreement(nearBlurred(), {Eye::left, {}, 0.5}) >= 40.0);
    CHECK(agreement(farBlurred(), {Eye::left, kBackgroundId, 1.0}) >= 40.0);
    Document behindCamera = nearBlurred().document;
    behindCamera.wearer.camera = CameraObserver{};
    behindCamera.wearer.camera->focusDistance = 0.6_m;
    behindCamera.scene.scale.focalPixels = 200.0;
    CHECK(agreement(played(behindCamera)) >= 40.0);
}

TEST_CASE("perceived: a still program is the plain view") {
    const Played still = played(document({region("left", Look::focus, 0.5, leftOf(70))}, Look::neutral, 2.0));
    CHECK(fast(still) == plainView(still.document, 1.0));
    CHECK(byRays(still) == plainView(still.document, 1.0));
}

TEST_CASE("perceived: a focused surface far from any border looks like the picture") {
    // While it is lit the lens moves by up to 0.2 D, and edges by a tenth of a pixel: the middles of blocks stay.
    const Played scene = onePlane();
    const Radiance seen = fast(scene), plain = plainView(scene.document, 1.0);
    double worst = 0.0;
    for (int y = 2; y < kSmall.height; y += 5) {
        for (int x = 2; x < 40; x += 5)
            worst = std::max(worst, std::abs(static_cast<double>(seen.at(x, y) - plain.at(x, y))));
    }
    CHECK(worst < 5e-3);  // eight bits of light
}

TEST_CASE("perceived: the two eyes see the magnified light shifted apart") {
    CHECK(psnr(fast(onePlane()), fast(onePlane(), {Eye::right, {}, 1.0})) < 40.0);
}

TEST_CASE("perceived: a uniform blurred surface is as bright as in steady light: radiance is conserved") {
    Document d = document({}, Look::blur, 0.5);
    d.scene.picture = Box<Picture>(Picture(kSmall, 3, std::vector<std::uint16_t>(160 * 120 * 3, 40000)));
    const Played scene = played(d);
    const float plain = plainView(d, 1.0).at(80, 60);
    CHECK(fast(scene).at(80, 60) == doctest::Approx(plain).epsilon(0.003));
}

TEST_CASE("perceived: layers share every pixel and lie nearest first") {
    const Played scene = allBlurred();
    for (const double scale : {1.0, 0.4}) {
        const auto cut = layers(scene.document, scene.plan, scale);
        REQUIRE(cut.size() == 3);
        CHECK(cut[0].region == "a");
        CHECK(cut[2].region == kBackgroundId);
        double worst = 0.0;
        for (std::size_t i = 0; i < cut[0].coverage.pixels().size(); ++i) {
            double sum = 0.0;
            for (const SceneLayer& layer : cut)
                sum += static_cast<double>(layer.coverage.pixels()[i]);
            worst = std::max(worst, std::abs(sum - 1.0));
        }
        CHECK(worst < 1e-5);
    }
}

TEST_CASE("perceived: a slanted surface is cut into layers without seams") {
    Document d = document({}, Look::focus, 0.5);
    Region desk = *d.background;
    desk.distance = PlaneDistance{{{{{0.0, 0.0}, 0.8_m}, {{160.0, 0.0}, 0.8_m}, {{80.0, 120.0}, 0.5_m}}}};
    d.background = Box<Region>(desk);
    d.scene.scale.focalPixels = 800.0;
    Region lamp = region("lamp", Look::blur, 0.4, disc(120, 30, 20));
    d.regions.push_back(Box<Region>(lamp));
    const Played scene = played(d);
    CHECK(layers(d, scene.plan, 1.0).size() > 3);
    const double dB = agreement(scene);
    MESSAGE("slanted: ", dB, " dB");
    CHECK(dB >= 40.0);
}

TEST_CASE("perceived: refusals") {
    const Played scene = onePlane();
    CHECK_FALSE(perceived(scene.document, scene.plan, scene.program, {Eye::left, {}, 0.0}));
    CHECK_FALSE(perceived(scene.document, scene.plan, scene.program, {Eye::left, "nobody", 1.0}));
    Document bare = scene.document;
    bare.scene.picture = {};
    CHECK(perceived(bare, scene.plan, scene.program, {}).error().fault == Fault::notFound);
}

TEST_CASE("perceived: psnr of known differences") {
    const Radiance a({2, 1}, 1, {0.0F, 1.0F}), b({2, 1}, 1, {0.1F, 1.0F});
    CHECK(std::isinf(psnr(a, a)));
    CHECK(psnr(a, b) == doctest::Approx(-10.0 * std::log10(0.005)));
}
