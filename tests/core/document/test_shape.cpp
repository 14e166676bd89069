// Shapes as coverage, and masks grown, shrunk, combined.
#include "core/document/shape.h"

#include <cmath>
#include <numbers>

#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

double area(const Mask& mask) {
    double sum = 0.0;
    const auto image = toImage(mask);
    for (const std::uint8_t v : image.pixels())
        sum += v / 255.0;
    return sum;
}

/// Every pixel of `a` is at least that of `b`.
bool contains(const Mask& a, const Mask& b) { return united(a, b) == a; }

/// A mask of 0 and 255 only.
Mask anyHardMask() {
    Mask mask = anyMask();
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            Tile tile = *mask.tile(column, row);
            for (std::uint8_t& v : tile.v)
                v = v >= 128 ? 255 : 0;
            mask.setTile(column, row, boxed(tile));
        }
    }
    return mask;
}

}  // namespace

TEST_CASE("shape: a rectangle's coverage is exact, down to the share of a pixel") {
    const Mask mask = rasterised(Rectangle{{10.25, 20.0}, {200.5, 100.5}}, {320, 200});
    CHECK(mask.at(10, 50) == 191);  // 0.75
    CHECK(mask.at(11, 50) == 255);
    CHECK(mask.at(9, 50) == 0);
    CHECK(mask.at(200, 50) == 128);
    CHECK(mask.at(201, 50) == 0);
    CHECK(mask.at(100, 19) == 0);
    CHECK(mask.at(100, 20) == 255);
    CHECK(mask.at(100, 100) == 128);
    CHECK(mask.at(200, 100) == 64);
    CHECK(mask.isUniform(1, 1, 0) == false);
    CHECK(mask.isUniform(4, 0, 0));  // x from 256 on: never touched
    CHECK(rasterised(Rectangle{{200.5, 100.5}, {10.25, 20.0}}, {320, 200}) == mask);
}

TEST_CASE("shape: a circle covers pi r^2 within 0.2 %") {
    for (const double r : {5.0, 20.0, 90.0}) {
        CAPTURE(r);
        const Mask mask = rasterised(Ellipse{{160.3 - r, 99.6 - r}, {160.3 + r, 99.6 + r}}, {320, 200});
        CHECK(area(mask) == doctest::Approx(std::numbers::pi * r * r).epsilon(0.002));
    }
}

TEST_CASE("shape: shapes reach beyond the picture on every side") {
    CHECK(rasterised(Rectangle{{-50.0, -50.0}, {500.0, 500.0}}, {320, 200}) == Mask({320, 200}, 255));
    CHECK(rasterised(Rectangle{{-90.0, -50.0}, {-10.0, 500.0}}, {320, 200}).blank());
    CHECK(rasterised(Rectangle{{330.0, -50.0}, {500.0, 500.0}}, {320, 200}).blank());
    // The half plane left of a slanted line: half of the picture, by symmetry.
    const Outline left{{{-1000.0, -100.0}, {260.0, -100.0}, {60.0, 300.0}, {-1000.0, 300.0}}};
    CHECK(area(rasterised(left, {320, 200})) == doctest::Approx(160.0 * 200.0).epsilon(1e-3));
}

TEST_CASE("shape: a polygon's coverage adds up to its area") {
    law("triangles inside the picture, both ways round", [] {
        const auto inside = [] {
            return Point<CameraFrame>{*rc::gen::inRange(0, 3200) / 10.0, *rc::gen::inRange(0, 2000) / 10.0};
        };
        const auto a = inside(), b = inside(), c = inside();
        const double expected = 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
        const Mask mask = rasterised(Outline{{a, b, c}}, {320, 200});
        const double rounding = 1.0 + 2.0 * (320.0 + 200.0) / 255.0;  // half a level at each pixel of the border
        RC_ASSERT(std::abs(area(mask) - expected) < rounding);
        RC_ASSERT(rasterised(Outline{{a, c, b}}, {320, 200}) == mask);
    });
}

TEST_CASE("shape: a lasso that crosses itself covers both of its loops") {
    const Mask mask = rasterised(Outline{{{20, 20}, {120, 120}, {120, 20}, {20, 120}}}, {320, 200});
    CHECK(mask.at(30, 70) == 255);
    CHECK(mask.at(110, 70) == 255);
    CHECK(mask.at(70, 30) == 0);
}

TEST_CASE("mask: inverted twice is the mask itself") {
    law("any mask", [] {
        const Mask mask = anyMask({333, 170});
        RC_ASSERT(inverted(inverted(mask)) == mask);
        RC_ASSERT(inverted(mask).at(5, 5) == 255 - mask.at(5, 5));
    });
}

TEST_CASE("mask: union and subtraction keep what the other does not touch") {
    law("lattice laws", [] {
        const Mask a = anyMask(), b = anyMask();
        RC_ASSERT(united(a, b) == united(b, a));
        RC_ASSERT(contains(united(a, b), a));
        RC_ASSERT(contains(a, subtracted(a, b)));
        RC_ASSERT(subtracted(a, b) == inverted(united(inverted(a), b)));
        RC_ASSERT(united(a, Mask(a.size())) == a);
        RC_ASSERT(subtracted(a, Mask(a.size(), 255)).blank());
    });
}

TEST_CASE("grow: grown contains the mask, shrunk is contained in it") {
    law("any mask, any radius", [] {
        const Mask mask = anyMask();
        const double radius = *rc::gen::inRange(1, 80) / 10.0;
        RC_ASSERT(contains(grown(mask, radius), mask));
        RC_ASSERT(contains(mask, grown(mask, -radius)));
        RC_ASSERT(grown(mask, 0.0) == mask);
    });
}

TEST_CASE("grow: to grow and shrink again closes gaps and loses nothing") {
    law("hard masks, whole radii", [] {
        const Mask mask = anyHardMask();
        const double radius = *rc::gen::inRange(1, 9);
        RC_ASSERT(contains(grown(grown(mask, radius), -radius), mask));
        RC_ASSERT(contains(mask, grown(grown(mask, -radius), radius)));
    });
}

TEST_CASE("grow: an anti-aliased edge moves by the radius and keeps its softness") {
    const Mask mask = rasterised(Rectangle{{50.25, 60.0}, {150.5, 120.0}}, {320, 200});
    const Mask wider = grown(mask, 7.0);
    CHECK(wider.at(43, 90) == 191);
    CHECK(wider.at(44, 90) == 255);
    CHECK(wider.at(42, 90) == 0);
    CHECK(wider.at(157, 90) == 128);
    CHECK(wider.at(158, 90) == 0);
    CHECK(grown(wider, -7.0).at(50, 90) == 191);
    // A fraction of a pixel is blended: the two columns at the edge hold it together.
    const Mask half = grown(mask, 7.5);
    CHECK(half.at(42, 90) + half.at(43, 90) == doctest::Approx(191 + 127.5).epsilon(0.01));

    const double r = 40.0;
    const Mask disc = rasterised(Ellipse{{160.0 - r, 100.0 - r}, {160.0 + r, 100.0 + r}}, {320, 200});
    CHECK(area(grown(disc, 20.0)) == doctest::Approx(std::numbers::pi * 60.0 * 60.0).epsilon(0.02));
    CHECK(area(grown(disc, -20.0)) == doctest::Approx(std::numbers::pi * 20.0 * 20.0).epsilon(0.06));
}

TEST_CASE("grow: the picture's border does not erode a region that reaches it") {
    CHECK(grown(Mask({320, 200}, 255), -10.0) == Mask({320, 200}, 255));
    const Mask left = rasterised(Rectangle{{-10.0, -10.0}, {100.0, 500.0}}, {320, 200});
    const Mask shrunk = grown(left, -10.0);
    CHECK(shrunk.at(0, 0) == 255);
    CHECK(shrunk.at(89, 199) == 255);
    CHECK(shrunk.at(90, 100) == 0);
}

}  // namespace ilf
