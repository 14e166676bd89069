#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/solid/draw.h"
#include "core/solid/extent.h"
#include "core/solid/pose.h"
#include "core/solid/raster.h"
#include "tests/core/solid/cast.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

using Position = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

Solid solidOf(std::vector<Position> positions, std::vector<Triangle> triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    Solid solid;
    solid.meshes.emplace_back(std::move(mesh));
    return solid;
}

/// In the camera's own space, so that the pose is nothing.
const Pose<CameraSpace, ModelSpace> kHere;

Solid soup(std::uint32_t seed, int count, double nearest) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> side(-1.5F, 1.5F), depth(static_cast<float>(nearest), 4.0F);
    std::vector<Position> positions;
    std::vector<Triangle> triangles;
    for (int i = 0; i < 3 * count; ++i)
        positions.push_back({side(random), side(random), depth(random)});
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i)
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    return solidOf(std::move(positions), std::move(triangles));
}

/// A sphere of bands around the origin.
Solid sphere(int bands, float radius) {
    std::vector<Position> positions;
    std::vector<Triangle> triangles;
    const int around = 2 * bands;
    for (int i = 0; i <= bands; ++i) {
        for (int j = 0; j < around; ++j) {
            const double a = 3.14159265358979 * i / bands, b = 3.14159265358979 * j / bands;
            positions.push_back({radius * static_cast<float>(std::sin(a) * std::cos(b)),
                                 radius * static_cast<float>(std::cos(a)),
                                 radius * static_cast<float>(std::sin(a) * std::sin(b))});
        }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * around + j % around); };
    for (int i = 0; i < bands; ++i) {
        for (int j = 0; j < around; ++j) {
            triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    }
    return solidOf(std::move(positions), std::move(triangles));
}

/// Every pixel whose ray passes all outlines by a thousandth of a pixel, against rays.
bool agrees(const Solid& solid, const Pinhole& camera) {
    const auto depth = drawnDepth(solid, camera, kHere);
    for (int y = 0; y < camera.size.height; ++y) {
        for (int x = 0; x < camera.size.width; ++x) {
            const Cast truth = cast(solid, camera, kHere, x + 0.5, y + 0.5);
            if (truth.margin < 1e-3) continue;
            const double got = static_cast<double>(depth.at(x, y));
            if (std::abs(got - truth.depth) > 1e-6 * std::max(1.0, truth.depth)) {
                MESSAGE("pixel ", x, ", ", y, ": ", got, " instead of ", truth.depth);
                return false;
            }
        }
    }
    return true;
}

}  // namespace

TEST_CASE("Depth is what rays against all triangles say, to a millionth") {
    law("depth of a soup of triangles", [] {
        const Solid solid = soup(*rc::gen::arbitrary<std::uint32_t>(), 12, 0.5);
        Pinhole camera = plainPinhole({40, 30}, 30.0);
        camera.cx += 0.37;
        camera.fy *= 1.1;
        RC_ASSERT(agrees(solid, camera));
    });
}

TEST_CASE("Triangles that reach behind the camera are cut, not thrown away or folded over") {
    Pinhole camera = plainPinhole({40, 30}, 25.0);
    // A floor from far behind the camera to far before it: nothing of its outline is in the picture's lower half.
    const Solid floor = solidOf({{-50, 1, -50}, {50, 1, -50}, {50, 1, 60}, {-50, 1, 60}}, {{0, 1, 2}, {0, 2, 3}});
    const auto depth = drawnDepth(floor, camera, kHere);
    for (int y = 0; y < 30; ++y) {
        const double slope = (y + 0.5 - camera.cy) / camera.fy;
        for (int x = 0; x < 40; ++x) {
            const double want = slope > 1.0 / 60.0 ? 1.0 / slope : 0.0;
            CHECK(static_cast<double>(depth.at(x, y)) == doctest::Approx(want).epsilon(1e-5));
        }
    }
    law("depth of a soup around the pinhole", [] {
        const Solid solid = soup(*rc::gen::arbitrary<std::uint32_t>(), 8, -2.0);
        const Pinhole close = plainPinhole({24, 18}, 12.0);
        const auto drawn = drawnDepth(solid, close, kHere);
        int wrong = 0;
        for (int y = 0; y < 18; ++y) {
            for (int x = 0; x < 24; ++x) {
                const double got = static_cast<double>(drawn.at(x, y));
                // Outlines behind the camera have no place in the picture: here the ray itself must be clear.
                const double a = cast(solid, close, kHere, x + 0.499, y + 0.499).depth;
                const double b = cast(solid, close, kHere, x + 0.501, y + 0.501).depth;
                const double want = cast(solid, close, kHere, x + 0.5, y + 0.5).depth;
                const bool clear = std::abs(a - want) < 1e-2 * want && std::abs(b - want) < 1e-2 * want;
                wrong += clear && std::abs(got - want) > 1e-5 * std::max(1.0, want) ? 1 : 0;
            }
        }
        RC_ASSERT(wrong == 0);
    });
}

TEST_CASE("Triangles that share edges leave no gap and overlap nowhere") {
    // A grid over more than the picture, each cell cut in two, vertices on pixel centres, on pixel borders and between.
    law("each pixel of a grid has one triangle", [] {
        const double step = *rc::gen::element(1.0, 0.5, 3.0, 7.3, 0.83);
        const double shift = *rc::gen::element(0.0, 0.5, 0.25, 0.1);
        const int cells = static_cast<int>(34.0 / step) + 2;
        std::vector<Position> positions;
        std::vector<Triangle> triangles;
        for (int j = 0; j <= cells; ++j) {
            for (int i = 0; i <= cells; ++i)
                positions.push_back({static_cast<float>((i * step - shift - 16.0) / 16.0),
                                     static_cast<float>((j * step - shift - 16.0) / 16.0), 1.0F});
        }
        const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
        for (int j = 0; j < cells; ++j) {
            for (int i = 0; i < cells; ++i) {
                triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});  // wound the other way
            }
        }
        const Pinhole camera = plainPinhole({32, 32}, 16.0);
        std::vector<int> drawnBy(32 * 32, 0);
        for (const Triangle& one : triangles) {
            const auto depth = drawnDepth(solidOf(positions, {one}), camera, kHere);
            for (std::size_t i = 0; i < drawnBy.size(); ++i)
                drawnBy[i] += depth.pixels()[i] > 0.0F ? 1 : 0;
            if (triangles.size() > 600) break;  // gaps alone are looked at, below
        }
        if (triangles.size() <= 600)
            RC_ASSERT(std::all_of(drawnBy.begin(), drawnBy.end(), [](int n) { return n == 1; }));
        const auto all = drawnDepth(solidOf(positions, triangles), camera, kHere);
        for (const float z : all.pixels())
            RC_ASSERT(z == 1.0F);
    });
}

TEST_CASE("A closed surface seen from within fills the picture") {
    law("no ray leaves a sphere", [] {
        const Solid ball = sphere(*rc::gen::inRange(6, 40), 2.0F);
        const double x = *rc::gen::inRange(-100, 100) * 0.01, z = *rc::gen::inRange(-100, 100) * 0.01;
        const auto pose = lookingAt({x, 0.1, z}, {x + 0.3, 0.4, z + 1.0});
        const auto depth = drawnDepth(ball, plainPinhole({48, 40}, 30.0), pose);
        for (const float away : depth.pixels())
            RC_ASSERT(away > 0.0F);
    });
}

TEST_CASE("A drawing over many tiles is the same each time and the same as its crop") {
    const Solid solid = soup(7, 300, 0.4);
    const Pinhole wide = plainPinhole({400, 300}, 350.0);
    const auto whole = drawn(solid, wide, kHere);
    CHECK(drawn(solid, wide, kHere).depth == whole.depth);
    CHECK(drawn(solid, wide, kHere).colour == whole.colour);
    CHECK(drawnDepth(solid, wide, kHere) == whole.depth);
    Pinhole crop = wide;
    crop.size = {50, 40};
    crop.cx -= 130.0;
    crop.cy -= 90.0;
    const auto part = drawnDepth(solid, crop, kHere);
    int differing = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 50; ++x)
            differing += std::abs(part.at(x, y) - whole.depth.at(x + 130, y + 90)) > 1e-5F ? 1 : 0;
    }
    CHECK(differing == 0);
}

TEST_CASE("Lens distortion bends the picture and leaves each pixel its own ray's depth") {
    Pinhole camera = plainPinhole({120, 90}, 100.0);
    camera.distortion = {-0.25, 0.08, 0.002, -0.001, 0.01};
    // A slanted plane: 1 / z = 0.5 + 0.2 * slope.
    const auto on = [](double x, double z) { return Position{static_cast<float>(x), 0.0F, static_cast<float>(z)}; };
    std::vector<Position> corners{on(-2.0, 2.8), on(2.0, 1.2), on(2.0, 1.2), on(-2.0, 2.8)};
    corners[0][1] = corners[1][1] = -3.0F;
    corners[2][1] = corners[3][1] = 3.0F;
    const Solid plane = solidOf(corners, {{0, 1, 2}, {0, 2, 3}});
    const auto depth = drawnDepth(plane, camera, kHere);
    int seen = 0;
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 120; ++x) {
            const auto [u, v] = camera.slopesOf(x + 0.5, y + 0.5);
            const double want = 2.0 / (1.0 + 0.4 * u);  // x = u z and z = 2 - 0.4 x
            if (depth.at(x, y) == 0.0F) continue;
            ++seen;
            CHECK(static_cast<double>(depth.at(x, y)) == doctest::Approx(want).epsilon(1e-6));
        }
    }
    CHECK(seen == 120 * 90);
}

TEST_CASE("Colours: a headlight on a wall, its texture in place, upright and wrapped") {
    Mesh mesh;
    mesh.positions = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = 0;
    Material material;
    material.colour = {1.0F, 1.0F, 1.0F};
    material.texture = Image<std::uint8_t>({2, 2}, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255});
    material.wrap = {Material::Wrap::clamp, Material::Wrap::clamp};
    Solid solid;
    solid.meshes.emplace_back(mesh);
    solid.materials.emplace_back(material);
    const Pinhole camera = plainPinhole({80, 80}, 40.0);
    const auto picture = drawn(solid, camera, kHere).colour;
    const auto rgb = [&](int x, int y) {
        return std::array<int, 3>{picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
    };
    // Quarters, clear of the middle, where the texels blend.
    CHECK(rgb(15, 15)[0] > 200);
    CHECK(rgb(15, 15)[1] < 10);
    CHECK(rgb(64, 15)[1] > 200);
    CHECK(rgb(64, 15)[0] < 10);
    CHECK(rgb(15, 64)[2] > 200);
    CHECK(rgb(64, 64)[0] > 200);
    CHECK(rgb(64, 64)[1] > 200);
    // Fainter where the light comes aslant: 0.2 + 0.8 cos, as linear light.
    mesh.material = -1;
    mesh.texcoords.clear();
    Solid plain;
    plain.meshes.emplace_back(mesh);
    const auto grey = drawn(plain, camera, kHere).colour;
    const auto linear = [](int code) { return std::pow((code / 255.0 + 0.055) / 1.055, 2.4); };
    const double cosine = 1.0 / std::sqrt(1.0 + std::pow(39.5 / 40.0, 2) + std::pow(0.5 / 40.0, 2));
    CHECK(linear(grey.at(40, 40, 0)) == doctest::Approx(0.8).epsilon(0.01));
    CHECK(linear(grey.at(79, 40, 0)) == doctest::Approx(0.8 * (0.2 + 0.8 * cosine)).epsilon(0.01));
}

TEST_CASE("Nothing in view is holes and black, and an empty solid draws") {
    const auto nothing = drawn(Solid{}, plainPinhole({16, 8}, 10.0), kHere);
    CHECK(nothing.depth.size() == Size{16, 8});
    for (const float z : nothing.depth.pixels())
        CHECK(z == 0.0F);
    const Solid behind = solidOf({{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}}, {{0, 1, 2}});
    const auto turned = drawn(behind, plainPinhole({16, 8}, 10.0), kHere);
    for (const std::uint8_t code : turned.colour.pixels())
        CHECK(code == 0);
    CHECK_FALSE(extentOf(Solid{}));
    CHECK(triangleCount(behind) == 1);
    CHECK(extentOf(behind) == Extent{{-1, -1, -1}, {1, 1, -1}});
}
