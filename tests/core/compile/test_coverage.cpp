// Masks on the raster, the blur disc, and distances to borders.
#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

#include "core/base/parallel.h"
#include "core/compile/coverage.h"
#include "core/compile/disc.h"
#include "core/document/shape.h"
#include "tests/support/law.h"

namespace {

using namespace ilf;

using Map = Homography<ProjectorFrame, CameraFrame>;

/// All of the mask on the raster.
TileGrid onRaster(const Mask& mask, Size projector, const Map& map) {
    const CoverageSampler sampler(mask.size(), projector, map);
    TileGrid grid(projector);
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            grid.setTile(column, row, sampler.tile(mask, column, row));
    return grid;
}

double total(const TileGrid& grid) {
    double sum = 0.0;
    for (int y = 0; y < grid.size().height; ++y)
        for (int x = 0; x < grid.size().width; ++x)
            sum += grid.at(x, y);
    return sum / 255.0;
}

}  // namespace

TEST_CASE("coverage: a raster that equals the picture shares the mask's own tiles") {
    const Mask mask = rasterised(Ellipse{{20, 20}, {180, 90}}, {200, 130});
    const TileGrid grid = onRaster(mask, {200, 130}, Map{});
    CHECK(grid == mask);
    CHECK(grid.tile(1, 1).same(mask.tile(1, 1)));
}

TEST_CASE("coverage: areas scale with the registration, whether it is axis-aligned or keystoned") {
    const Mask mask = rasterised(Ellipse{{100, 60}, {300, 220}}, {400, 300});
    for (const double k : {0.3, 0.53, 1.0, 1.7}) {
        const Size projector{static_cast<int>(400 * k), static_cast<int>(300 * k)};
        CHECK(total(onRaster(mask, projector, Map{{k, 0, 0, 0, k, 0, 0, 0, 1}})) ==
              doctest::Approx(k * k * total(mask)).epsilon(0.002));
        // The same scale reached through a rotation by a hair takes the other way through the sampler.
        CHECK(total(onRaster(mask, projector, Map{{k, 1e-9, 0, 0, k, 0, 0, 0, 1}})) ==
              doctest::Approx(k * k * total(mask)).epsilon(0.004));
    }
}

TEST_CASE("coverage: a line thinner than a projector pixel dims every pixel it crosses") {
    std::vector<std::uint8_t> pixels(std::size_t{400} * 400, 0);
    for (std::size_t y = 0; y < 400; ++y)
        pixels[y * 400 + 201] = 255;
    const Mask line = toTiles(Image<std::uint8_t>({400, 400}, 1, pixels));
    for (const Map& map : {Map{{0.25, 0, 0, 0, 0.25, 0, 0, 0, 1}}, Map{{0.25, 1e-9, 0, 0, 0.25, 0, 0, 0, 1}}}) {
        const TileGrid grid = onRaster(line, {100, 100}, map);
        for (int y = 0; y < 100; ++y)
            CHECK(grid.at(49, y) + grid.at(50, y) + grid.at(51, y) == doctest::Approx(64).epsilon(0.05));
    }
}

TEST_CASE("coverage: outside the picture nothing is covered") {
    const TileGrid grid = onRaster(Mask({64, 64}, 255), {256, 128}, Map{{1, 0, 100, 0, 1, 30, 0, 0, 1}});
    CHECK(grid.at(99, 60) == 0);
    CHECK(grid.at(100, 60) == 255);
    CHECK(grid.at(163, 93) == 255);
    CHECK(grid.at(164, 60) == 0);
    CHECK(total(grid) == 64 * 64);
}

TEST_CASE("disc: weights sum to one, and the fast sums equal the weighted ones") {
    law("fast equals plain", [] {
        const Disc disc(*rc::gen::inRange(0, 130) / 10.0);
        double sum = 0.0;
        for (int dy = -disc.reach(); dy <= disc.reach(); ++dy)
            for (int dx = -disc.reach(); dx <= disc.reach(); ++dx)
                sum += disc.weight(dx, dy);
        RC_ASSERT(std::abs(sum - 1.0) < 1e-5);

        const PixelRect<ProjectorFrame> at{-3, 5, 9, 12};
        Patch<std::uint8_t> light(at.grown(disc.reach() + 1));
        for (auto& v : light.v)
            v = *rc::gen::arbitrary<std::uint8_t>();
        const Patch<float> fast = disc.averaged(light, at);
        for (int y = at.y0; y < at.y1; ++y) {
            for (int x = at.x0; x < at.x1; ++x) {
                double plain = 0.0;
                for (int dy = -disc.reach(); dy <= disc.reach(); ++dy)
                    for (int dx = -disc.reach(); dx <= disc.reach(); ++dx)
                        plain += disc.weight(dx, dy) * light(x + dx, y + dy);
                RC_ASSERT(std::abs(fast(x, y) - plain) < 1e-3);
            }
        }
    });
}

TEST_CASE("disc: its second moment is that of a disc of its radius and one pixel") {
    for (const double radius : {2.0, 3.7, 7.0, 12.5}) {
        const Disc disc(radius);
        double moment = 0.0;
        for (int dy = -disc.reach(); dy <= disc.reach(); ++dy)
            for (int dx = -disc.reach(); dx <= disc.reach(); ++dx)
                moment += disc.weight(dx, dy) * dx * dx;
        CHECK(moment == doctest::Approx(radius * radius / 4.0).epsilon(0.06));
    }
}

TEST_CASE("parallel: every index is visited once, also from several threads and from inside a loop") {
    const auto visitedOnce = [] {
        std::vector<std::atomic<int>> visits(500);
        parallelFor(500, [&](int i) {
            if (i % 50 == 0) parallelFor(3, [&](int) {});
            ++visits[static_cast<std::size_t>(i)];
        });
        return std::all_of(visits.begin(), visits.end(), [](const auto& v) { return v == 1; });
    };
    std::atomic<int> good{0};
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 50; ++i)
                    good += visitedOnce() ? 1 : 0;
            });
    }
    CHECK(good == 200);
}
