#include "core/compile/dense_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/parallel.h"

namespace ilf {

namespace {

/// Above this many camera pixels a projector pixel, supersampling stops growing: 8 x 8 samples a pixel.
constexpr int kMaxSamples = 8;

/// Of the steps to the two neighbours the smaller one.
float smoother(float back, float ahead) { return std::abs(back) < std::abs(ahead) ? back : ahead; }

/// How many samples along a side a pixel of that many camera pixels needs.
int samplesFor(double scale) { return std::clamp(static_cast<int>(std::ceil(scale - 1e-6)), 1, kMaxSamples); }

int whole(float v) { return static_cast<int>(std::clamp(std::floor(v), -1e8F, 1e8F)); }

}  // namespace

/// The parallelogram of a projector pixel in the picture: centre, and steps to the next pixel across and down.
struct DenseCoverage::Area {
    float x, y, acrossX, acrossY, downX, downY;
};

DenseCoverage::Area DenseCoverage::areaOf(int x, int y) const {
    const Image<float>& map = map_->cameraOfProjector;
    const int i = std::min(x, map.width() - 1), j = std::min(y, map.height() - 1);  // tiles reach over the raster's end
    const float* here = map.row(j) + 2 * i;
    const auto step = [&](std::ptrdiff_t by, int channel, bool before, bool after) {
        const float back = before ? here[channel] - here[channel - by] : 0.0F;
        const float ahead = after ? here[channel + by] - here[channel] : 0.0F;
        if (!before || !after) return before ? back : ahead;
        return smoother(back, ahead);
    };
    const auto line = static_cast<std::ptrdiff_t>(map.stride());
    const bool left = i > 0, right = i + 1 < map.width(), above = j > 0, below = j + 1 < map.height();
    return {here[0],
            here[1],
            step(2, 0, left, right),
            step(2, 1, left, right),
            step(line, 0, above, below),
            step(line, 1, above, below)};
}

/// As for the homography that fits best, or more where the scene is so much nearer that most of the tile needs it.
int DenseCoverage::samplesOver(int column, int row) const {
    const auto back = map_->nearest.inverted();
    const double cx = column * kTile + kTile / 2.0, cy = row * kTile + kTile / 2.0;
    const auto p = back(Point<ProjectorFrame>{cx, cy});
    const auto px = back(Point<ProjectorFrame>{cx + 1, cy}), py = back(Point<ProjectorFrame>{cx, cy + 1});
    const double plane = std::max(std::hypot(px.x - p.x, px.y - p.y), std::hypot(py.x - p.x, py.y - p.y));
    std::vector<float> scales;
    for (int y = 2; y < kTile; y += 5) {
        for (int x = 2; x < kTile; x += 5) {
            const Area area = areaOf(column * kTile + x, row * kTile + y);
            scales.push_back(std::max(std::hypot(area.acrossX, area.acrossY), std::hypot(area.downX, area.downY)));
        }
    }
    const auto middle = scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2);
    std::nth_element(scales.begin(), middle, scales.end());
    constexpr double kNoise = 0.95;  // a scan's jitter shall not double the work
    return std::max(samplesFor(plane), samplesFor(kNoise * static_cast<double>(*middle)));
}

DenseCoverage::Table DenseCoverage::tableOf(int column, int row) const {
    Table table;
    table.samples = samplesOver(column, row);
    const float out = table.samples == 1 ? 0.0F : 0.5F * (1.0F - 1.0F / static_cast<float>(table.samples));
    for (int top = row * kTile; top < (row + 1) * kTile; top += kSquare) {
        for (int left = column * kTile; left < (column + 1) * kTile; left += kSquare) {
            constexpr float kFar = std::numeric_limits<float>::max();
            float x0 = kFar, y0 = kFar, x1 = -kFar, y1 = -kFar;
            for (int y = top; y < top + kSquare; ++y) {
                for (int x = left; x < left + kSquare; ++x) {
                    const Area a = areaOf(x, y);
                    const float rx = out * (std::abs(a.acrossX) + std::abs(a.downX));
                    const float ry = out * (std::abs(a.acrossY) + std::abs(a.downY));
                    x0 = std::min(x0, a.x - rx), x1 = std::max(x1, a.x + rx);
                    y0 = std::min(y0, a.y - ry), y1 = std::max(y1, a.y + ry);
                }
            }
            // Interpolation reads the pixels on both sides of a sample; one more for rounding.
            table.squares.push_back(
                {whole(x0 - 0.5F) - 1, whole(y0 - 0.5F) - 1, whole(x1 - 0.5F) + 3, whole(y1 - 0.5F) + 3});
            table.source = table.source.united(table.squares.back());
        }
    }
    return table;
}

DenseCoverage::DenseCoverage(const Box<DenseMap>& map) : map_(map) {
    columns_ = (map_->projector().width + kTile - 1) / kTile;
    rows_ = (map_->projector().height + kTile - 1) / kTile;
    tables_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    parallelFor(columns_ * rows_,
                [&](int i) { tables_[static_cast<std::size_t>(i)] = tableOf(i % columns_, i / columns_); });
}

Tile DenseCoverage::tile(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column,
                         int row) const {
    const Table& table = tables_[index(column, row)];
    const auto width = static_cast<std::size_t>(at.width());
    // Samples beside the picture are moved to its dark rim.
    const float endX = static_cast<float>(at.width()) - 1.001F, endY = static_cast<float>(at.height()) - 1.001F;
    const float cornerX = static_cast<float>(at.x0) + 0.5F, cornerY = static_cast<float>(at.y0) + 0.5F;
    const auto value = [&](float x, float y) {
        const float fx = std::min(std::max(x - cornerX, 0.0F), endX), fy = std::min(std::max(y - cornerY, 0.0F), endY);
        const auto ix = static_cast<int>(fx), iy = static_cast<int>(fy);
        const float ax = fx - static_cast<float>(ix), ay = fy - static_cast<float>(iy);
        const std::uint8_t* p = &pixels[static_cast<std::size_t>(iy) * width + static_cast<std::size_t>(ix)];
        const std::uint8_t* q = p + width;
        const float a = static_cast<float>(p[0]), b = static_cast<float>(p[1]);
        const float c = static_cast<float>(q[0]), d = static_cast<float>(q[1]);
        const float top = a + ax * (b - a), bottom = c + ax * (d - c);
        return top + ay * (bottom - top);
    };
    const auto flat = [&](PixelRect<CameraFrame> touched) -> std::optional<std::uint8_t> {
        const PixelRect<CameraFrame> r{
            std::clamp(touched.x0, at.x0, at.x1 - 1), std::clamp(touched.y0, at.y0, at.y1 - 1),
            std::clamp(touched.x1, at.x0 + 1, at.x1), std::clamp(touched.y1, at.y0 + 1, at.y1)};
        const std::uint8_t* first =
            &pixels[static_cast<std::size_t>(r.y0 - at.y0) * width + static_cast<std::size_t>(r.x0 - at.x0)];
        const auto bytes = static_cast<std::size_t>(std::max(1, r.width()));
        if (std::memcmp(first, first + 1, bytes - 1) != 0) return std::nullopt;
        const std::uint8_t* line = first;
        for (int y = r.y0 + 1; y < r.y1; ++y)
            if (std::memcmp(first, line += width, bytes) != 0) return std::nullopt;
        return *first;
    };
    const int n = table.samples;
    const float step = 1.0F / static_cast<float>(n), begin = 0.5F * step - 0.5F, share = step * step;
    Tile tile;
    for (int square = 0; square < kSquares * kSquares; ++square) {
        const int left = square % kSquares * kSquare, top = square / kSquares * kSquare;
        if (const auto same = flat(table.squares[static_cast<std::size_t>(square)])) {
            for (int y = top; y < top + kSquare; ++y)
                std::memset(&tile.at(left, y), *same, kSquare);
            continue;
        }
        for (int y = top; y < top + kSquare; ++y) {
            for (int x = left; x < left + kSquare; ++x) {
                const Area a = areaOf(column * kTile + x, row * kTile + y);
                float sum = 0.0F;
                for (int j = 0; j < n; ++j) {
                    const float v = begin + static_cast<float>(j) * step;
                    for (int i = 0; i < n; ++i) {
                        const float u = begin + static_cast<float>(i) * step;
                        sum += value(a.x + u * a.acrossX + v * a.downX, a.y + u * a.acrossY + v * a.downY);
                    }
                }
                tile.at(x, y) = static_cast<std::uint8_t>(static_cast<int>(sum * share + 0.5F));
            }
        }
    }
    return tile;
}

}  // namespace ilf
