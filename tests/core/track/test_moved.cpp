// Masks and documents that move: exact for whole pixels, close to the shape painted there for any motion.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

#include "core/compile/compile.h"
#include "core/document/shape.h"
#include "core/track/moved_mask.h"
#include "tests/core/document/scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kSize{320, 200};

Motion turned(double degrees, double x, double y, double scale = 1.0) {
    const double c = scale * std::cos(degrees * 0.017453292519943295),
                 s = scale * std::sin(degrees * 0.017453292519943295);
    return {{c, -s, x, s, c, y, 0, 0, 1}};
}

Outline outlineOf(const Quad& q) { return {{q.begin(), q.end()}}; }

int worst(const Mask& a, const Mask& b) {
    int most = 0;
    for (int y = 0; y < a.size().height; ++y) {
        for (int x = 0; x < a.size().width; ++x)
            most = std::max(most, std::abs(a.at(x, y) - b.at(x, y)));
    }
    return most;
}

/// Sum of differences of coverage, pixels of area.
double areaError(const Mask& a, const Mask& b) {
    double sum = 0.0;
    for (int y = 0; y < a.size().height; ++y) {
        for (int x = 0; x < a.size().width; ++x)
            sum += std::abs(a.at(x, y) - b.at(x, y)) / 255.0;
    }
    return sum;
}

double lengthOf(const Quad& q) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        sum += std::hypot(q[(i + 1) % 4].x - q[i].x, q[(i + 1) % 4].y - q[i].y);
    return sum;
}

/// Most area error per length of border, px, when a mask is enlarged by `scale`. Both masks are the shape averaged over
/// a window, and the L1 distance of a border seen through two symmetric windows, the one more spread, is the difference
/// of their mean absolute offsets along the normal. Ours: a mask pixel (variance scale^2 / 12), the bilinear weights
/// (scale^2 / 6 averaged over phases), n samples a side ((1 - 1/n^2) / 12); its mean offset is at most the root of the
/// sum, and scale / 2 at the worst phase of an upright edge too. The truth's is that of one pixel, least at 45 degrees:
/// sqrt(2) / 6. Besides half a step of rounding in both masks over the at most 3 scale + 2 pixels across.
double mostError_px(double scale) {
    const double n = std::clamp(std::ceil(1.0 / scale - 0.25), 1.0, 4.0);
    const double ours = std::sqrt(scale * scale / 4.0 + (1.0 - 1.0 / (n * n)) / 12.0);
    return ours - std::sqrt(2.0) / 6.0 + (3.0 * scale + 2.0) / 255.0;
}

Document following(Look look, Follow::WhenLost lost) {
    Document document = twoRegions();
    Region face = *findRegion(document, "a");
    face.look = look;
    face.mask = rasterised(Rectangle{{60, 50}, {140, 120}}, kSize);
    face.follow = Follow{};
    face.follow->whenLost = lost;
    document.regions[0] = Box(face);
    return document;
}

}  // namespace

TEST_CASE("a shift by whole pixels moves every value as it is") {
    law("exact", [] {
        const Mask mask = anyMask();
        const int dx = *rc::gen::inRange(-150, 150), dy = *rc::gen::inRange(-150, 150);
        const Mask at = moved(mask, turned(0, dx, dy));
        for (int y = 0; y < kSize.height; ++y) {
            for (int x = 0; x < kSize.width; ++x)
                RC_ASSERT(at.at(x, y) == mask.at(x - dx, y - dy));
        }
    });
}

TEST_CASE("a moved shape is the shape drawn there, to what bilinear sampling blurs its border") {
    law("shape", [] {
        const Quad shape{{{120, 60}, {190, 70}, {180, 130}, {110, 120}}};
        const double scale = *rc::gen::inRange(50, 130) / 100.0;
        const Motion motion =
            turned(*rc::gen::inRange(-40, 41), *rc::gen::inRange(-30, 100), *rc::gen::inRange(-40, 41), scale);
        const Mask painted = rasterised(outlineOf(shape), kSize);
        const Quad there = moved(shape, motion);
        const Mask truth = rasterised(outlineOf(there), kSize);
        RC_ASSERT(areaError(moved(painted, motion), truth) <= mostError_px(scale) * lengthOf(there));
    });
}

TEST_CASE("tiles that nothing touches are shared, and so are equal ones of the answer before") {
    const Mask mask = rasterised(Rectangle{{10, 10}, {50, 50}}, kSize);
    const Motion motion = turned(0, 3.5, 0);
    const Mask at = moved(mask, motion);
    CHECK(at.isUniform(4, 2, 0));
    const Mask again = moved(mask, motion, &at);
    int changed = 0;
    forEachChangedTile(at, again, [&](int, int) { ++changed; });
    CHECK(changed == 0);
    CHECK(worst(at, again) == 0);
}

TEST_CASE("less than a twentieth of a pixel is no motion") {
    const Mask mask = rasterised(Rectangle{{10, 10}, {50, 50}}, kSize);
    const Mask at = moved(mask, turned(0, 0.04, 0));
    int changed = 0;
    forEachChangedTile(mask, at, [&](int, int) { ++changed; });
    CHECK(changed == 0);
    CHECK(worst(mask, moved(mask, turned(0, 0.2, 0))) > 30);
}

TEST_CASE("a motion that cannot be undone, or that sends the mask behind the camera, leaves no light elsewhere") {
    const Mask mask = rasterised(Rectangle{{10, 10}, {50, 50}}, kSize);
    CHECK(moved(mask, Motion{{0, 0, 0, 0, 0, 0, 0, 0, 1}}) == mask);
    CHECK(moved(mask, turned(0, 5000, 0)).blank());
    const Mask horizon = moved(mask, Motion{{1, 0, 0, 0, 1, 0, 0.02, 0, 1}});
    CHECK(horizon.size() == kSize);
}

TEST_CASE("the middle of a mask is by coverage") {
    CHECK(middleOf(rasterised(Rectangle{{10, 20}, {50, 60}}, kSize)).x == doctest::Approx(30));
    CHECK(middleOf(rasterised(Rectangle{{10, 20}, {250, 180}}, kSize)).y == doctest::Approx(100));
    CHECK(middleOf(Mask(kSize)).x == doctest::Approx(160));
}

TEST_CASE("only regions that follow are moved, with outline and plane") {
    Document document = following(Look::focus, Follow::WhenLost::neutral);
    Region face = *document.regions[0];
    PlaneDistance plane;
    plane.anchors = {{{{60, 50}, 1.0_m}, {{140, 50}, 1.2_m}, {{60, 120}, 1.1_m}}};
    face.distance = plane;
    face.outline = Outline{{{60, 50}, {140, 50}, {140, 120}, {60, 120}}};
    document.regions[0] = Box(face);
    const std::vector<RegionMotion> motions{{"a", turned(0, 20, 10), 0.0}, {"b", turned(0, 9, 9), 1.0}, {"x", {}, 0.5}};
    const Document at = moved(document, motions);
    REQUIRE(at.regions.size() == 2);
    CHECK(at.regions[1].same(document.regions[1]));
    CHECK(at.regions[0]->mask.at(81, 61) == 255);
    CHECK(at.regions[0]->mask.at(61, 51) == 0);
    CHECK(at.regions[0]->outline->vertices[0] == Point<CameraFrame>{80, 60});
    CHECK(std::get<PlaneDistance>(at.regions[0]->distance).anchors[1].at == Point<CameraFrame>{160, 60});
    CHECK(at.regions[0]->look == Look::focus);
}

TEST_CASE("while it fades a region is on its way to the safe look, and has it at last") {
    Document document = following(Look::focus, Follow::WhenLost::blur);
    Document safe = document;
    Region lost = *document.regions[0];
    lost.look = Look::blur;
    safe.regions[0] = Box(lost);
    CHECK(moved(document, std::vector<RegionMotion>{{"a", {}, 0.0}}) == document);
    for (const double fade : {0.01, 0.5, 0.99}) {
        const Document at = moved(document, std::vector<RegionMotion>{{"a", {}, fade}});
        CHECK(at.regions[0]->look == Look::focus);
        CHECK(at.regions[0]->fade == LookFade{Look::blur, fade});
    }
    CHECK(moved(document, std::vector<RegionMotion>{{"a", {}, 1.0}}) == safe);
    lost.strength = 0.7_D;  // its own blur gives way to the safe one
    document.regions[0] = Box(lost);
    CHECK(moved(document, std::vector<RegionMotion>{{"a", {}, 0.5}}).regions[0]->fade == LookFade{Look::blur, 0.5});
    CHECK(moved(document, std::vector<RegionMotion>{{"a", {}, 1.0}}) == safe);
}

TEST_CASE("a private region that is blurred as it is stays so throughout") {
    const Document document = following(Look::blur, Follow::WhenLost::blur);
    for (const double fade : {0.0, 0.3, 1.0})
        CHECK(moved(document, std::vector<RegionMotion>{{"a", {}, fade}}) == document);
}

TEST_CASE("the light leaves the focus level evenly") {
    const Document document = following(Look::focus, Follow::WhenLost::blur);
    for (const double fade : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Document at = moved(document, std::vector<RegionMotion>{{"a", {}, fade}});
        const auto planned = plan(planInput(at));
        REQUIRE(planned);
        const auto compiled = compile(at, *planned);
        REQUIRE(compiled);
        // The middle of the region, in the light of the focus level.
        const auto on = pixelMap(at).toProjector({100, 85});
        int focus = -1;
        for (std::size_t i = 0; i < planned->levels.size(); ++i) {
            if (planned->levels[i].kind == LevelKind::focus) focus = static_cast<int>(i);
        }
        const double light = focus < 0 ? 0.0
                                       : compiled->program.images[static_cast<std::size_t>(focus)].at(
                                             static_cast<int>(on.x), static_cast<int>(on.y)) /
                                             255.0;
        CHECK(std::abs(light - (1.0 - fade)) < 1.0 / 255.0);
    }
}

}  // namespace ilf
