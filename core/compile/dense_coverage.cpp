#include "core/compile/dense_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/parallel.h"

namespace ilf {

namespace {

/// Of the steps to the two neighbours the smaller one.
float smoother(float back, float ahead) { return std::abs(back) < std::abs(ahead) ? back : ahead; }

/// The one that as many of `values` exceed as do not.
float medianOf(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

int whole(float v) { return static_cast<int>(std::clamp(std::floor(v), -1e8F, 1e8F)); }

}  // namespace

/// The parallelogram of a projector pixel in the picture: centre, and steps to the next pixel across and down.
struct DenseCoverage::Area {
    float x, y, acrossX, acrossY, downX, downY;
};

/// Those of a square and one more on every side.
struct DenseCoverage::Places {
    static constexpr int kSide = kSquare + 2;
    std::array<float, std::size_t{2} * kSide * kSide> v;
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

/// Beyond the raster the map goes on as it does beside its border.
DenseCoverage::Places DenseCoverage::placesAround(int left, int top) const {
    const Image<float>& map = map_->cameraOfProjector;
    // What lies at i is twice what lies at `near` less what lies at `far`: inside, both are i itself.
    struct Index {
        int near, far;
    };
    const auto along = [](int i, int size) {
        const int near = std::clamp(i, 0, size - 1);
        return Index{near, std::clamp(i == -1 ? 1 : i == size ? size - 2 : near, 0, size - 1)};
    };
    Places places;
    std::size_t at = 0;
    for (int y = top - 1; y <= top + kSquare; ++y) {
        const Index j = along(y, map.height());
        for (int x = left - 1; x <= left + kSquare; ++x) {
            const Index i = along(x, map.width());
            for (int channel = 0; channel < 2; ++channel)
                places.v[at++] = 2.0F * map.at(i.near, j.near, channel) - map.at(i.far, j.far, channel);
        }
    }
    return places;
}

/// As for the homography that fits best, or more where the scene is so much nearer that most of the tile needs it.
Sampling DenseCoverage::samplingOver(int column, int row) const {
    const auto back = map_->nearest.inverted();
    const double cx = column * kTile + kTile / 2.0, cy = row * kTile + kTile / 2.0;
    const auto p = back(Point<ProjectorFrame>{cx, cy});
    const auto px = back(Point<ProjectorFrame>{cx + 1, cy}), py = back(Point<ProjectorFrame>{cx, cy + 1});
    const double plane = std::max(std::hypot(px.x - p.x, px.y - p.y), std::hypot(py.x - p.x, py.y - p.y));
    std::vector<float> scales, reachX, reachY;
    for (int y = 2; y < kTile; y += 5) {
        for (int x = 2; x < kTile; x += 5) {
            const Area area = areaOf(column * kTile + x, row * kTile + y);
            scales.push_back(std::max(std::hypot(area.acrossX, area.acrossY), std::hypot(area.downX, area.downY)));
            reachX.push_back(std::hypot(area.acrossX, area.downX));
            reachY.push_back(std::hypot(area.acrossY, area.downY));
        }
    }
    constexpr double kNoise = 0.95;  // a scan's jitter shall not double the work
    const int points = std::max(pointsFor(plane), pointsFor(kNoise * static_cast<double>(medianOf(scales))));
    return samplingFor(points, static_cast<double>(medianOf(reachX)), static_cast<double>(medianOf(reachY)));
}

DenseCoverage::Table DenseCoverage::tableOf(int column, int row) const {
    Table table;
    table.sampling = samplingOver(column, row);
    const float out = 0.5F * (1.0F - 1.0F / static_cast<float>(table.sampling.points));
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
            // Interpolation reads the pixels on both sides of a sample, and these depend on their neighbours.
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

Tile DenseCoverage::tile(const MaskPatch& patch, int column, int row) const {
    const Table& table = tables_[index(column, row)];
    const Image<float>& map = map_->cameraOfProjector;
    Tile tile;
    for (int square = 0; square < kSquares * kSquares; ++square) {
        const int left = square % kSquares * kSquare, top = square / kSquares * kSquare;
        std::uint8_t* to = &tile.at(left, top);
        if (const auto same = patch.flatOver(table.squares[static_cast<std::size_t>(square)])) {
            for (int y = 0; y < kSquare; ++y)
                std::memset(to + y * kTile, *same, kSquare);
            continue;
        }
        const int x = column * kTile + left, y = row * kTile + top;
        if (x > 0 && y > 0 && x + kSquare < map.width() && y + kSquare < map.height()) {
            coverSquare(patch, table.sampling, map.row(y) + 2 * x, static_cast<std::ptrdiff_t>(map.stride()), to);
        } else {
            const Places places = placesAround(x, y);
            constexpr std::ptrdiff_t kStride = 2 * Places::kSide;
            coverSquare(patch, table.sampling, &places.v[kStride + 2], kStride, to);
        }
    }
    return tile;
}

}  // namespace ilf
