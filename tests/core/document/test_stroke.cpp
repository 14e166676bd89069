// Strokes: dabs as data, and what they leave on a mask.
#include "core/document/stroke.h"

#include <algorithm>
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

}  // namespace

TEST_CASE("paint: a stroke painted dab by dab is the stroke painted at once") {
    law("any dabs, either mode, protected or not", [] {
        Document start = *edited(twoRegions(), SetMask{"a", anyMask(), ""});
        start = *edited(start, SetMask{"b", anyMask(), ""});
        const auto dabs = anyDabs();
        const PaintMode mode = anyMode();
        const bool protect = *rc::gen::arbitrary<bool>();
        Document slowly = start;
        for (const Dab& dab : dabs)
            slowly = *edited(slowly, Paint{"a", {dab}, mode, protect});
        RC_ASSERT(slowly == *edited(start, Paint{"a", dabs, mode, protect}));
    });
}

TEST_CASE("paint: the order of dabs does not matter") {
    law("backwards is forwards", [] {
        const Mask mask = anyMask();
        auto dabs = anyDabs();
        const PaintMode mode = anyMode();
        const Mask forwards = painted(mask, dabs, mode);
        std::reverse(dabs.begin(), dabs.end());
        RC_ASSERT(painted(mask, dabs, mode) == forwards);
    });
}

TEST_CASE("paint: tiles out of reach are the same boxes") {
    law("only tiles inside reach change", [] {
        const Mask before = anyMask();
        const auto dabs = anyDabs(3);
        const Mask after = painted(before, dabs, anyMode());
        forEachChangedTile(before, after, [&](int column, int row) {
            const bool reached = std::any_of(dabs.begin(), dabs.end(), [&](const Dab& dab) {
                const auto r = reach(dab).clipped(before.size());
                return !r.empty() && r.x0 / kTile <= column && column <= (r.x1 - 1) / kTile && r.y0 / kTile <= row &&
                       row <= (r.y1 - 1) / kTile;
            });
            RC_ASSERT(reached);
        });
    });
}

TEST_CASE("paint: nothing outside a dab's reach changes") {
    law("pixels outside reach keep their value", [] {
        const Mask before = anyMask();
        const Dab dab = anyDab();
        const auto inside = reach(dab);
        const auto was = toImage(before);
        const auto is = toImage(painted(before, {dab}, anyMode()));
        for (int y = 0; y < was.height(); ++y) {
            for (int x = 0; x < was.width(); ++x) {
                const bool reached = x >= inside.x0 && x < inside.x1 && y >= inside.y0 && y < inside.y1;
                RC_ASSERT(reached || was.at(x, y) == is.at(x, y));
            }
        }
    });
}

TEST_CASE("paint: erasing with the same hard dabs leaves nothing inside") {
    law("what was fully covered is gone", [] {
        auto dabs = anyDabs();
        for (Dab& dab : dabs)
            dab.brush.hardness = dab.brush.opacity = 1.0;
        const Mask covered = painted(Mask({320, 200}), dabs, PaintMode::add);
        const auto was = toImage(covered);
        const auto is = toImage(painted(covered, dabs, PaintMode::erase));
        for (std::size_t i = 0; i < was.pixels().size(); ++i) {
            if (was.pixels()[i] == 255) RC_ASSERT(is.pixels()[i] == 0);
        }
    });
}

TEST_CASE("paint: protected pixels keep room for what the others cover") {
    law("painted coverage and the others' never exceed 255 where there was none before", [] {
        const Document start = *edited(twoRegions(), SetMask{"b", anyMask(), ""});
        const Document next = *edited(start, Paint{"a", anyDabs(), PaintMode::add, true});
        const auto own = toImage(findRegion(next, "a")->mask);
        const auto other = toImage(findRegion(next, "b")->mask);
        for (std::size_t i = 0; i < own.pixels().size(); ++i)
            RC_ASSERT(own.pixels()[i] + other.pixels()[i] <= 255);
    });
}

TEST_CASE("paint: a hard dab covers the area of its circle, a soft one three tenths of it") {
    const auto areaOf = [](double radius, double hardness) {
        return area(painted(Mask({400, 400}), {{{200.3, 199.8}, {radius, hardness, 1.0}}}, PaintMode::add));
    };
    for (const double r : {3.0, 10.0, 40.0, 150.0}) {
        CAPTURE(r);
        CHECK(areaOf(r, 1.0) == doctest::Approx(std::numbers::pi * r * r).epsilon(0.02 / r));
    }
    // Volume of the falloff 3t^2 - 2t^3 over a disc, t = 1 - d/r: 2 pi r^2 (1 - 5/4 + 2/5) = 0.3 pi r^2.
    CHECK(areaOf(100.0, 0.0) == doctest::Approx(0.3 * std::numbers::pi * 1e4).epsilon(0.003));
}

TEST_CASE("paint: opacity is the most a stroke covers, however often it passes") {
    const Dab dab{{100.0, 100.0}, {20.0, 1.0, 0.5}};
    const Mask mask = painted(Mask({200, 200}), {dab, dab, dab}, PaintMode::add);
    CHECK(mask.at(100, 100) == 128);
}

TEST_CASE("stroke: the same dabs, however the pointer's way was split") {
    law("split anywhere along the way", [] {
        const Point<CameraFrame> from = anyPoint(), to = anyPoint();
        const Brush brush = anyBrush();
        std::optional<double> whole;
        const auto expected = spacedDabs(from, to, brush, whole);

        std::optional<double> parts;
        std::vector<Dab> dabs;
        auto shares = *rc::gen::container<std::vector<int>>(5, rc::gen::inRange(0, 1001));
        std::sort(shares.begin(), shares.end());
        shares.push_back(1000);
        Point<CameraFrame> last = from;
        for (const int share : shares) {
            const double s = share / 1000.0;
            const Point<CameraFrame> next{from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)};
            const auto some = spacedDabs(last, next, brush, parts);
            dabs.insert(dabs.end(), some.begin(), some.end());
            last = next;
        }
        RC_ASSERT(dabs.size() == expected.size());
        for (std::size_t i = 0; i < dabs.size(); ++i) {
            RC_ASSERT(std::hypot(dabs[i].at.x - expected[i].at.x, dabs[i].at.y - expected[i].at.y) < 1e-5);
        }
        RC_ASSERT(std::abs(*parts - *whole) < 1e-5);
    });
}

TEST_CASE("stroke: dabs lie close enough that a hard stroke has no scallops deeper than a quarter pixel") {
    for (const double r : {0.5, 1.0, 5.0, 20.0, 100.0, 1000.0}) {
        CAPTURE(r);
        const double spacing = dabSpacing({r, 1.0, 1.0});
        CHECK(spacing >= 1.0);
        CHECK(r - std::sqrt(r * r - 0.25 * spacing * spacing) <= (r < 1.0 ? 0.5 : 0.26));
    }
    std::optional<double> carry;
    const auto dabs = spacedDabs({10.0, 10.0}, {110.0, 10.0}, {20.0, 1.0, 1.0}, carry);
    REQUIRE(dabs.size() == 21);
    CHECK(dabs[0].at == Point<CameraFrame>{10.0, 10.0});
    CHECK(dabs[20].at.x == doctest::Approx(110.0));
    CHECK(spacedDabs({110.0, 10.0}, {110.0, 10.0}, {20.0, 1.0, 1.0}, carry).empty());
}

}  // namespace ilf
