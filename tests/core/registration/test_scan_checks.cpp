// Before a scan: is the room dark enough? After it: does the map hold?
#include <cmath>

#include "core/registration/ambient.h"
#include "core/registration/hole_filling.h"
#include "core/registration/map_check.h"
#include "tests/support/law.h"
#include "tests/support/synthetic_scan.h"

using namespace ilf;

namespace {

Image<std::uint8_t> level(int value, Size size = {40, 30}) {
    return {size, 1,
            std::vector<std::uint8_t>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
                                      static_cast<std::uint8_t>(value))};
}

SyntheticCamera desk() {
    SyntheticCamera at;
    at.look = [](double x, double y) { return std::array{0.46 * x + 0.02 * y + 3.0, 0.47 * y + 2.0}; };
    return at;
}

}  // namespace

TEST_CASE("ambient: go in a dim room, and in one as bright as the projector") {
    // 40 lux beside a projector's 400: black at a tenth of the light.
    const auto dim = ambientCheck(level(165), level(15));
    REQUIRE(dim);
    CHECK(dim->go);
    CHECK(dim->projectorShare == doctest::Approx(150.0 / 165.0).epsilon(0.01));
    CHECK(dim->contrast == 150.0);
    // 200 lux beside 200.
    CHECK(ambientCheck(level(200), level(100))->go);
}

TEST_CASE("ambient: no go, with the reason, when the room wins, light is weak, missing, or too much") {
    const auto room = ambientCheck(level(200), level(160));
    REQUIRE(room);
    CHECK(!room->go);
    CHECK(room->what.find("Only 20 % of the light is the projector's: dim the room") != std::string::npos);
    CHECK(ambientCheck(level(12), level(4))->what.find("expose longer") != std::string::npos);
    CHECK(ambientCheck(level(100), level(99))->what.find("reaches only 0 %") != std::string::npos);
    CHECK(ambientCheck(level(255), level(20))->what.find("shorten the exposure") != std::string::npos);
    for (const auto& [white, black] : {std::pair{12, 4}, {100, 99}, {255, 20}})
        CHECK(!ambientCheck(level(white), level(black))->go);
}

TEST_CASE("ambient: more light in the room is never better") {
    law("monotone", [] {
        const int light = *rc::gen::inRange(0, 200), less = *rc::gen::inRange(0, 100), more = *rc::gen::inRange(0, 100);
        const auto a = ambientCheck(level(std::min(255, light + less)), level(less));
        const auto b = ambientCheck(level(std::min(255, light + less + more)), level(less + more));
        RC_ASSERT(!b->go || a->go);
    });
}

TEST_CASE("ambient: refuses pictures of two sizes") {
    const auto check = ambientCheck(level(100), level(10, {20, 30}));
    REQUIRE(!check);
    CHECK(check.error().what.find("one size") != std::string::npos);
}

TEST_CASE("map check: a good map holds; one that is a pixel off does not pass for better than that") {
    const SyntheticCamera at = desk();
    const auto map = denseMap(*decodedScan(scanned(at)));
    REQUIRE(map);
    for (const Pattern::Kind kind : {Pattern::Kind::column, Pattern::Kind::row}) {
        const Pattern pattern = checkPattern(kind, at.projector);
        const auto picture = photographed(at, pattern, 100);
        const auto inverse = photographed(at, {pattern.kind, pattern.bit, true}, 101);
        const auto good = mapCheck(*map, pattern, picture, inverse);
        REQUIRE(good);
        CHECK(good->holds());
        CHECK(good->rms_px < 0.1);
        CHECK(good->worst_px > good->rms_px);  // a true largest residual, of noise
        CHECK(good->worst_px < 1.0);
        CHECK(good->edges > 500);
        // The projector was bumped: the same light lands 2.5 raster pixels farther.
        SyntheticCamera bumped = at;
        bumped.look = [at](double x, double y) {
            const auto p = at.look(x, y);
            return std::array{p[0] + 2.5, p[1] + 2.5};
        };
        const auto off = mapCheck(*map, pattern, photographed(bumped, pattern, 102),
                                  photographed(bumped, {pattern.kind, pattern.bit, true}, 103));
        REQUIRE(off);
        CHECK(!off->holds());
        CHECK(off->rms_px == doctest::Approx(2.5).epsilon(0.1));
        CHECK(off->worst_px > 2.5);
    }
}

TEST_CASE("map check: nothing seen is no success, and wrong pictures are refused") {
    const SyntheticCamera at = desk();
    const auto map = denseMap(*decodedScan(scanned(at)));
    REQUIRE(map);
    const Pattern pattern = checkPattern(Pattern::Kind::column, at.projector);
    const auto nothing = mapCheck(*map, pattern, level(80, at.camera), level(80, at.camera));
    REQUIRE(nothing);
    CHECK(nothing->edges == 0);
    CHECK(!nothing->holds());
    CHECK(!mapCheck(*map, pattern, level(80), level(80)));
    CHECK(!mapCheck(*map, {Pattern::Kind::white, 0, false}, level(80, at.camera), level(80, at.camera)));
}

TEST_CASE("hole filling: known numbers stay, a constant continues as itself, nothing becomes zero") {
    law("push-pull", [] {
        const int width = *rc::gen::inRange(1, 40), height = *rc::gen::inRange(1, 40);
        const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        Field field{{width, height}, std::vector<float>(2 * pixels, 0.0F), std::vector<float>(pixels, 0.0F)};
        const auto known = *rc::gen::container<std::vector<bool>>(pixels, rc::gen::arbitrary<bool>());
        bool any = false;
        for (std::size_t n = 0; n < pixels; ++n) {
            if (!known[n]) continue;
            field.known[n] = 1.0F;
            field.values[2 * n] = 3.5F;
            field.values[2 * n + 1] = -2.0F;
            any = true;
        }
        fillHoles(field);
        for (std::size_t n = 0; n < pixels; ++n) {
            RC_ASSERT(std::abs(field.values[2 * n] - (any ? 3.5F : 0.0F)) < 1e-4F);
            RC_ASSERT(std::abs(field.values[2 * n + 1] - (any ? -2.0F : 0.0F)) < 1e-4F);
        }
    });
}

TEST_CASE("hole filling: between known numbers holes lie between them, nearer to the nearer") {
    Field field{{64, 64}, std::vector<float>(2 * 64 * 64, 0.0F), std::vector<float>(64 * 64, 0.0F)};
    for (std::size_t y = 0; y < 64; ++y) {
        field.known[64 * y] = field.known[64 * y + 63] = 1.0F;
        field.values[2 * (64 * y + 63)] = 10.0F;
    }
    fillHoles(field);
    const auto at = [&](std::size_t x) { return field.values[2 * (64 * 32 + x)]; };
    CHECK(at(0) == 0.0F);
    CHECK(at(63) == 10.0F);
    CHECK(at(32) == doctest::Approx(5.0).epsilon(0.2));
    CHECK(at(10) < at(32));
    CHECK(at(32) < at(53));
}
