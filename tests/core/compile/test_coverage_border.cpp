// How near the coverage of projector pixels is to what a shape truly covers of them, beside plain interpolation.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/compile/coverage.h"
#include "core/document/shape.h"
#include "tests/support/law.h"
#include "tests/support/scanned_map.h"

namespace {

using namespace ilf;

using Plane = Homography<ProjectorFrame, CameraFrame>;
constexpr Size kBordered{260, 200};
constexpr Ellipse kBorder{{31.3, 28.6}, {221.8, 170.1}};

/// `scale` camera pixels a projector pixel, turned by `angle` about the picture's middle, which is the raster's.
Plane turned(double scale, double angle, Size raster) {
    const double c = std::cos(angle) / scale, s = std::sin(angle) / scale;
    const double x = 0.5 * kBordered.width, y = 0.5 * kBordered.height;
    return {{c, -s, 0.5 * raster.width - c * x + s * y, s, c, 0.5 * raster.height - s * x - c * y, 0, 0, 1}};
}

Size rasterFor(double scale) {
    return {static_cast<int>(kBordered.width / scale) + 4, static_cast<int>(kBordered.height / scale) + 4};
}

TileGrid coveredBy(const Mask& mask, Size raster, const PixelMap& map) {
    const CoverageSampler sampler(mask.size(), raster, map);
    TileGrid grid(raster);
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            grid.setTile(column, row, sampler.tile(mask, column, row));
    return grid;
}

cv::Mat interpolated(const Mask& mask, Size raster, const Plane& map) {
    const Image<std::uint8_t> image = toImage(mask);
    const cv::Mat from(kBordered.height, kBordered.width, CV_8U, const_cast<std::uint8_t*>(image.pixels().data()));
    const auto back = map.inverted();
    cv::Mat places(raster.height, raster.width, CV_32FC2), to;
    for (int y = 0; y < raster.height; ++y) {
        for (int x = 0; x < raster.width; ++x) {
            const auto c = back(Point<ProjectorFrame>{x + 0.5, y + 0.5});
            places.at<cv::Vec2f>(y, x) = {static_cast<float>(c.x - 0.5), static_cast<float>(c.y - 0.5)};
        }
    }
    cv::remap(from, to, places, cv::noArray(), cv::INTER_LINEAR);
    return to;
}

/// Shares of pixels that the shape truly covers, counted over 12 x 12 points where its border comes near.
std::vector<double> trueShares(Size raster, const Plane& map) {
    const auto back = map.inverted();
    const double cx = 0.5 * (kBorder.a.x + kBorder.b.x), rx = 0.5 * (kBorder.b.x - kBorder.a.x);
    const double cy = 0.5 * (kBorder.a.y + kBorder.b.y), ry = 0.5 * (kBorder.b.y - kBorder.a.y);
    constexpr int kPoints = 12;
    std::vector<double> shares;
    for (int y = 0; y < raster.height; ++y) {
        for (int x = 0; x < raster.width; ++x) {
            const auto isInside = [&](double px, double py) {
                const auto c = back(Point<ProjectorFrame>{px, py});
                return std::hypot((c.x - cx) / rx, (c.y - cy) / ry) <= 1.0 ? 1 : 0;
            };
            // The shape is much larger than a pixel: what its neighbours' middles do not part, it does not cut.
            int around = 0;
            for (int i = 0; i < 9; ++i)
                around += isInside(x + 0.5 + (i % 3 - 1), y + 0.5 + (i / 3 - 1));
            if (around == 0 || around == 9) {
                shares.push_back(around == 0 ? 0.0 : 1.0);
                continue;
            }
            int inside = 0;
            for (int i = 0; i < kPoints * kPoints; ++i)
                inside += isInside(x + (i % kPoints + 0.5) / kPoints, y + (i / kPoints + 0.5) / kPoints);
            shares.push_back(inside / static_cast<double>(kPoints * kPoints));
        }
    }
    return shares;
}

/// Root of the mean squared difference over the pixels at the border.
template <class Covered>
double borderError(const std::vector<double>& shares, Size raster, const Covered& covered) {
    double sum = 0.0, pixels = 0.0;
    for (int y = 0; y < raster.height; ++y) {
        for (int x = 0; x < raster.width; ++x) {
            const double share = shares[static_cast<std::size_t>(y * raster.width + x)];
            if (share == 0.0 || share == 1.0) continue;
            sum += std::pow(covered(x, y) / 255.0 - share, 2);
            pixels += 1.0;
        }
    }
    return std::sqrt(sum / pixels);
}

}  // namespace

TEST_CASE("coverage: borders are nearer to what was painted than interpolation's, through a homography and a scan") {
    const Mask mask = rasterised(kBorder, kBordered);
    law("border", [&] {
        const double scale = *rc::gen::inRange(50, 300) / 100.0, angle = *rc::gen::inRange(1, 780) / 1000.0;
        const Size raster = rasterFor(scale);
        const Plane map = turned(scale, angle, raster);
        const auto shares = trueShares(raster, map);
        const cv::Mat plain = interpolated(mask, raster, map);
        const double theirs = borderError(
            shares, raster, [&](int x, int y) { return static_cast<double>(plain.at<std::uint8_t>(y, x)); });
        for (const PixelMap& way : {PixelMap(map), PixelMap(Box<DenseMap>(sampledMap(map, kBordered, raster)))}) {
            const TileGrid grid = coveredBy(mask, raster, way);
            const double ours =
                borderError(shares, raster, [&](int x, int y) { return static_cast<double>(grid.at(x, y)); });
            RC_LOG() << "scale " << scale << " angle " << angle << ": " << ours << " beside " << theirs << '\n';
            RC_ASSERT(ours < 0.95 * theirs);
        }
    });
}

TEST_CASE("coverage: what is one camera pixel thin gives its light wherever it falls on the raster") {
    law("thin", [] {
        const double scale = *rc::gen::inRange(100, 500) / 100.0, angle = *rc::gen::inRange(1, 300) / 1000.0;
        const int at = *rc::gen::inRange(90, 170);
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(kBordered.width) *
                                         static_cast<std::size_t>(kBordered.height));
        for (int y = 40; y < 160; ++y)
            pixels[static_cast<std::size_t>(y * kBordered.width + at)] = 255;
        const Mask line = toTiles(Image<std::uint8_t>(kBordered, 1, pixels));
        const Size raster = rasterFor(scale);
        const TileGrid grid = coveredBy(line, raster, PixelMap(turned(scale, angle, raster)));
        double sum = 0.0;
        for (int y = 0; y < raster.height; ++y)
            for (int x = 0; x < raster.width; ++x)
                sum += grid.at(x, y) / 255.0;
        RC_LOG() << "scale " << scale << " angle " << angle << ": " << sum * scale * scale / 120.0 << '\n';
        // Sharpening takes from both sides of the line what cannot be less than dark: up to a seventh too bright.
        RC_ASSERT(sum * scale * scale / 120.0 > 0.97);
        RC_ASSERT(sum * scale * scale / 120.0 < 1.15);
    });
}
