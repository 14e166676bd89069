// How long a mask takes onto the raster through a scanned map: a whole slot, and the tiles of one dab; and how far its
// coverage is from the truth, counted point by point.
#include <benchmark/benchmark.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/base/parallel.h"
#include "core/compile/coverage.h"
#include "core/document/shape.h"
#include "tests/support/scanned_map.h"

namespace {

using namespace ilf;

using Plane = Homography<ProjectorFrame, CameraFrame>;
constexpr Size kCamera{1280, 1024}, kRaster{1024, 768};
const Plane kPlane{{0.78, 0.02, 12, -0.01, 0.74, 6, 1e-5, 5e-6, 1}};
constexpr Point<CameraFrame> kFrom{300, 200}, kTo{1000, 820};

const CoverageSampler& sampler() {
    static const CoverageSampler made(kCamera, kRaster, PixelMap(Box<DenseMap>(sampledMap(kPlane, kCamera, kRaster))));
    return made;
}

TileGrid onRaster(const Mask& mask) {
    TileGrid grid(kRaster);
    std::vector<Box<Tile>> tiles(static_cast<std::size_t>(grid.columns() * grid.rows()));
    parallelFor(static_cast<int>(tiles.size()), [&](int i) {
        tiles[static_cast<std::size_t>(i)] = sampler().tile(mask, i % grid.columns(), i / grid.columns());
    });
    for (std::size_t i = 0; i < tiles.size(); ++i)
        grid.setTile(static_cast<int>(i) % grid.columns(), static_cast<int>(i) / grid.columns(), tiles[i]);
    return grid;
}

/// Root of the mean squared difference from an ellipse's true coverage, over the pixels at its border; 0..1.
/// `covered`: 0..255 of a pixel of the raster.
template <class Covered>
double coverageError(const Covered& covered) {
    const auto back = kPlane.inverted();
    const double cx = 0.5 * (kFrom.x + kTo.x), cy = 0.5 * (kFrom.y + kTo.y);
    const double rx = 0.5 * (kTo.x - kFrom.x), ry = 0.5 * (kTo.y - kFrom.y);
    constexpr int kPoints = 16;
    double sum = 0.0, pixels = 0.0;
    for (int y = 0; y < kRaster.height; ++y) {
        for (int x = 0; x < kRaster.width; ++x) {
            int inside = 0;
            for (int i = 0; i < kPoints * kPoints; ++i) {
                const auto c =
                    back(Point<ProjectorFrame>{x + (i % kPoints + 0.5) / kPoints, y + (i / kPoints + 0.5) / kPoints});
                inside += std::hypot((c.x - cx) / rx, (c.y - cy) / ry) <= 1.0 ? 1 : 0;
            }
            if (inside == 0 || inside == kPoints * kPoints) continue;
            const double difference = covered(x, y) / 255.0 - inside / static_cast<double>(kPoints * kPoints);
            sum += difference * difference;
            pixels += 1.0;
        }
    }
    return std::sqrt(sum / pixels);
}

void warpSlot(benchmark::State& state) {
    const Mask mask = rasterised(Ellipse{kFrom, kTo}, kCamera);
    TileGrid grid = onRaster(mask);
    for (auto _ : state)
        benchmark::DoNotOptimize(grid = onRaster(mask));
    state.counters["error"] = coverageError([&](int x, int y) { return grid.at(x, y); });
    state.SetLabel("of coverage at the border, rms");
}
BENCHMARK(warpSlot)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

/// OpenCV's remap of the whole mask, bilinear, through the same places: no area is averaged.
void warpRemap(benchmark::State& state) {
    cv::setNumThreads(2);
    const Image<std::uint8_t> mask = toImage(rasterised(Ellipse{kFrom, kTo}, kCamera));
    const cv::Mat from(kCamera.height, kCamera.width, CV_8U, const_cast<std::uint8_t*>(mask.pixels().data()));
    const auto back = kPlane.inverted();
    cv::Mat places(kRaster.height, kRaster.width, CV_32FC2), to;
    for (int y = 0; y < places.rows; ++y) {
        for (int x = 0; x < places.cols; ++x) {
            const auto c = back(Point<ProjectorFrame>{x + 0.5, y + 0.5});
            places.at<cv::Vec2f>(y, x) = {static_cast<float>(c.x - 0.5), static_cast<float>(c.y - 0.5)};
        }
    }
    for (auto _ : state)
        cv::remap(from, to, places, cv::noArray(), cv::INTER_LINEAR);
    state.counters["error"] = coverageError([&](int x, int y) { return to.at<std::uint8_t>(y, x); });
    state.SetLabel("of coverage at the border, rms");
}
BENCHMARK(warpRemap)->Unit(benchmark::kMicrosecond)->UseRealTime();

/// No square of it is even: what a slot can cost at most.
void warpNoise(benchmark::State& state) {
    std::vector<std::uint8_t> pixels(std::size_t{1280} * 1024);
    std::uint32_t seed = 7;
    for (auto& v : pixels)
        v = static_cast<std::uint8_t>((seed = seed * 1664525U + 1013904223U) >> 24);
    const Mask mask = toTiles(Image<std::uint8_t>(kCamera, 1, std::move(pixels)));
    for (auto _ : state)
        benchmark::DoNotOptimize(onRaster(mask));
}
BENCHMARK(warpNoise)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

void warpDab(benchmark::State& state) {
    const Mask mask = rasterised(Ellipse{{620, 480}, {700, 560}}, kCamera);  // a brush of 40 px
    std::vector<std::pair<int, int>> reached;
    for (int row = 0; row < kRaster.height / kTile; ++row) {
        for (int column = 0; column < kRaster.width / kTile; ++column) {
            const auto needed = sampler().source(column, row).clipped(kCamera);
            if (needed.x0 < 701 && needed.x1 > 619 && needed.y0 < 561 && needed.y1 > 479)
                reached.emplace_back(column, row);
        }
    }
    for (auto _ : state) {
        parallelFor(static_cast<int>(reached.size()), [&](int i) {
            const auto [column, row] = reached[static_cast<std::size_t>(i)];
            benchmark::DoNotOptimize(sampler().tile(mask, column, row));
        });
    }
    state.counters["tiles"] = static_cast<double>(reached.size());
}
BENCHMARK(warpDab)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

/// What a new map costs once.
void prepareMap(benchmark::State& state) {
    const PixelMap map(Box<DenseMap>(sampledMap(kPlane, kCamera, kRaster)));
    for (auto _ : state)
        benchmark::DoNotOptimize(CoverageSampler(kCamera, kRaster, map));
}
BENCHMARK(prepareMap)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
