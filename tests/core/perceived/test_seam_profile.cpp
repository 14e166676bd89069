// The seam at the cursor: where it is found, its sign from the geometry, and what blending leaves.
#include "core/perceived/seam_profile.h"

#include <cmath>

#include "tests/core/perceived/small_scene.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

constexpr Size kWide{800, 300};

/// A picture at 2 px/mm, lenses' axes on the camera's, and a blurred strip at 0.5 m left of `x` on a focused wall.
Compiled leftStrip(int x, double wall_m = 0.5) {
    Document d = document({region("strip", Look::blur, 0.5, maskOf(kWide, [=](int i, int) { return i < x; }))},
                          Look::focus, wall_m, kWide);
    d.scene.scale.focalPixels = 2000.0 * 0.52;
    d.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    d.wearer.axes = {LensAxis{}, LensAxis{}};
    const Played p = played(d);
    Compiled compiled;
    compiled.document = p.document;
    compiled.plan = p.plan;
    compiled.program = p.program;
    return compiled;
}

}  // namespace

TEST_CASE("seam profile: found at the border nearest to the cursor, or not at all") {
    const Compiled compiled = leftStrip(600);
    const auto profile = seamProfile(compiled, {590.0, 150.0}, 20.0);
    REQUIRE(profile);
    CHECK(profile->at.x == doctest::Approx(600.0));
    CHECK(profile->nx == doctest::Approx(1.0));
    CHECK(std::abs(profile->ny) < 1e-9);
    CHECK(profile->blurred == "strip");
    CHECK(profile->other == kBackgroundId);
    CHECK_FALSE(seamProfile(compiled, {560.0, 150.0}, 20.0));
}

TEST_CASE(
    "seam profile: light that grows away from the centre overlaps its neighbour, light that leaves it opens a gap") {
    // Border 100 mm right of the centre; the strip contains the centre, so its light moves out over the wall.
    const auto overlap = seamProfile(leftStrip(600), {600.0, 150.0}, 10.0);
    REQUIRE(overlap);
    CHECK_FALSE(overlap->gap);
    CHECK(overlap->left.before[64] > 1.2F);
    // Border 100 mm left of the centre; the strip lies outside, its light moves away from the wall.
    const auto gap = seamProfile(leftStrip(200), {200.0, 150.0}, 10.0);
    REQUIRE(gap);
    CHECK(gap->gap);
    CHECK(gap->left.before[64] < 0.8F);
}

TEST_CASE("seam profile: without blending the seam is (s - 1) |x - c| wide and as deep as blur leaves it") {
    const Compiled compiled = leftStrip(600);
    const auto profile = seamProfile(compiled, {600.0, 150.0}, 10.0);
    const double s = magnification(compiled.plan.input.eye, 0.5_m, 0.0_D, compiled.plan.waveform.high);
    CHECK(profile->seamWidth_mm == doctest::Approx((s - 1.0) * 100.0).epsilon(1e-6));
    // Overlap of hard masks: 2 where both lie, 1 elsewhere, softened by the disc only on the blurred side.
    CHECK(profile->left.worstWeberBefore > 0.8);
    CHECK(profile->left.worstWeberBefore < 1.01);
    CHECK(profile->left.before.front() == doctest::Approx(1.0).epsilon(0.01));
    CHECK(profile->left.before.back() == doctest::Approx(1.0).epsilon(0.01));
    // This program has hard masks, so before and after agree.
    for (std::size_t i = 0; i < profile->left.before.size(); ++i) {
        CHECK(profile->left.after[i] == doctest::Approx(profile->left.before[i]).epsilon(0.01));
    }
    CHECK(profile->left.before == profile->right.before);
}

TEST_CASE("seam profile: says where one surface stands before the other, since nothing is blended there") {
    const auto onOneSurface = seamProfile(leftStrip(600), {600.0, 150.0}, 10.0);
    REQUIRE(onOneSurface);
    CHECK_FALSE(onOneSurface->depthStep);
    const auto beforeTheWall = seamProfile(leftStrip(600, 0.8), {600.0, 150.0}, 10.0);
    REQUIRE(beforeTheWall);
    CHECK(beforeTheWall->depthStep);
}

TEST_CASE("seam profile: two eyes see different seams") {
    Compiled compiled = leftStrip(600);
    compiled.document.wearer = Wearer{};
    const auto profile = seamProfile(compiled, {600.0, 150.0}, 10.0);
    REQUIRE(profile);
    CHECK(profile->left.before != profile->right.before);
    CHECK(profile->seamWidth_mm > 5.0);  // the left eye's: 131.5 mm from its centre
}

TEST_CASE("seam profile: none in a scene that has no sweep") {
    const Played p =
        played(document({region("strip", Look::focus, 0.5, maskOf(kWide, [](int i, int) { return i < 300; }))},
                        Look::focus, 0.5, kWide));
    Compiled compiled;
    compiled.document = p.document;
    compiled.plan = p.plan;
    compiled.program = p.program;
    CHECK_FALSE(seamProfile(compiled, {300.0, 150.0}, 50.0));
}

TEST_CASE("seam profile: the closed form leaves nothing of the seam, the paper's ramps much of it") {
    Document d = leftStrip(600).document;
    const auto worstWith = [&](Blending blending) {
        d.seam.blending = blending;
        const auto compiled = compile(d, *plan(planInput(d)));
        REQUIRE(compiled);
        return seamProfile(*compiled, {600.0, 150.0}, 10.0)->left.worstWeberAfter;
    };
    CHECK(worstWith(Blending::closedForm) < 0.01);
    CHECK(worstWith(Blending::linearPerceived) > 0.03);
    CHECK(worstWith(Blending::linearObject) > 0.5);
    CHECK(worstWith(Blending::none) > 0.8);
}
