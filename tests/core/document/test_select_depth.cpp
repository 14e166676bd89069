// Select by depth: on surfaces whose right answer is known, and on real depth cameras' frames.
#include "core/document/select_depth.h"

#include <cmath>
#include <functional>
#include <random>

#include "core/document/wearer_distances.h"
#include "core/registration/pinhole.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kSize{240, 160};

DepthMap depthFrom(const std::function<double(int, int)>& metres, double noise_D = 0.0) {
    std::mt19937 random(11);
    std::normal_distribution<double> off(0.0, noise_D > 0.0 ? noise_D : 1.0);
    std::vector<float> values;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            const double d = metres(x, y);
            values.push_back(d > 0.0 ? static_cast<float>(1.0 / (1.0 / d + (noise_D > 0.0 ? off(random) : 0.0)))
                                     : 0.0F);
        }
    }
    return {Image<float>(kSize, 1, std::move(values)), {}, {}};
}

Picture grey() { return {kSize, 1, std::vector<std::uint16_t>(std::size_t{240} * 160, 30000)}; }

/// Share of pixels, of those where `truth` is or the mask is, on which they agree.
double agreement(const Mask& mask, const std::function<bool(int, int)>& truth) {
    double both = 0.0, either = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            const double m = mask.at(x, y) / 255.0, t = truth(x, y) ? 1.0 : 0.0;
            both += std::min(m, t);
            either += std::max(m, t);
        }
    }
    return both / either;
}

bool disc(int x, int y) { return std::hypot(x + 0.5 - 120.0, y + 0.5 - 80.0) < 32.0; }

/// A desk that recedes steeply upwards, in vergence a plane.
double desk(int, int y) { return 1.0 / (0.6 + 0.012 * y); }

}  // namespace

TEST_CASE("select by depth: a box that stands before a wall is selected to its edge, however flat or steep the wall") {
    law("any gap, any noise below it", [] {
        const double gap = *rc::gen::inRange(4, 40) * 0.01, noise = *rc::gen::element(0.0, 0.001, 0.003);
        const DepthMap depth =
            depthFrom([&](int x, int y) { return disc(x, y) ? 1.0 / (1.0 / desk(x, y) + gap) : desk(x, y); }, noise);
        const auto box = surfaceAt(depth, grey(), {120.5, 80.5});
        if (!box) RC_FAIL(box.error().what);
        RC_ASSERT(agreement(*box, disc) > 0.93);
        const auto wall = surfaceAt(depth, grey(), {20.5, 20.5});
        if (!wall) RC_FAIL(wall.error().what);
        RC_ASSERT(agreement(*wall, [](int x, int y) { return !disc(x, y); }) > 0.95);
    });
}

TEST_CASE("select by depth: a surface ends where it bends into another, without a step between them") {
    // A desk up to row 90, from there a wall that stands upright on it.
    const auto corner = [](int, int y) { return y > 90 ? 1.0 / (0.8 + 0.01 * (y - 90)) : 1.0 / 0.8; };
    const DepthMap depth = depthFrom(corner, 0.0005);
    const auto table = surfaceAt(depth, grey(), {120.5, 140.5});
    REQUIRE(table);
    CHECK(agreement(*table, [](int, int y) { return y > 90; }) > 0.93);
    const auto wall = surfaceAt(depth, grey(), {120.5, 20.5});
    REQUIRE(wall);
    CHECK(agreement(*wall, [](int, int y) { return y <= 90; }) > 0.93);
}

TEST_CASE("select by depth: small holes are bridged and filled, large ones are not") {
    const auto holed = [](int x, int y) {
        if (std::hypot(x - 60.0, y - 80.0) < 4.0 || std::hypot(x - 170.0, y - 80.0) < 25.0) return 0.0;
        return x % 17 == 0 ? 0.0 : desk(x, y);  // and columns the sensor lost
    };
    const auto found = surfaceAt(depthFrom(holed), grey(), {20.5, 20.5});
    REQUIRE(found);
    CHECK(found->at(60, 80) == 255);
    CHECK(found->at(51, 40) == 255);
    CHECK(found->at(170, 80) == 0);
    CHECK(agreement(*found, [](int x, int y) { return std::hypot(x - 170.0, y - 80.0) >= 25.0; }) > 0.95);
}

TEST_CASE("select by depth: a map that knows itself to be uncertain does not end surfaces at its own noise") {
    DepthMap depth = depthFrom(desk, 0.03);
    // Half of the picture is worse than the rest, so that the picture's own spread does not tell.
    depth.sigma = Image<float>(kSize, 1, std::vector<float>(std::size_t{240} * 160, 0.04F));
    const auto found = surfaceAt(depth, grey(), {120.5, 80.5});
    REQUIRE(found);
    CHECK(agreement(*found, [](int, int) { return true; }) > 0.9);
}

TEST_CASE("select by depth: colour edges end a surface only when asked to") {
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x)
            pixels.push_back(disc(x, y) ? 60000 : 20000);
    }
    const Picture paper(kSize, 1, std::move(pixels));
    const DepthMap depth = depthFrom(desk);
    CHECK(agreement(*surfaceAt(depth, paper, {120.5, 80.5}), [](int, int) { return true; }) > 0.99);
    CHECK(agreement(*surfaceAt(depth, paper, {120.5, 80.5}, {1.0, true}), disc) > 0.93);
}

TEST_CASE("select by depth: refused without a depth map, outside it, and where nothing was measured") {
    const auto refusal = [](const DepthMap& depth, Point<CameraFrame> at, SurfaceSelection how = {}) {
        const auto found = surfaceAt(depth, grey(), at, how);
        return found ? std::string() : found.error().what;
    };
    CHECK(refusal({}, {1, 1}).starts_with("This scene has no depth map to select by"));
    const DepthMap depth = depthFrom([](int x, int y) { return x < 40 ? 0.0 : desk(x, y); });
    CHECK(refusal(depth, {-1, 5}).starts_with("The click was outside the picture"));
    CHECK(refusal(depth, {300, 5}).starts_with("The click was outside the picture"));
    CHECK(refusal(depth, {10, 50}).starts_with("No surface was measured there"));
    CHECK(refusal(depth, {100, 50}, {0.0, false}).find("from 0.1 to 10") != std::string::npos);
    CHECK(refusal(depth, {100, 50}).empty());
}

}  // namespace ilf
