#include "core/compile/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/compile/patch.h"

namespace ilf {

CoverageSampler::CoverageSampler(Size picture, Size projector,
                                 const Homography<ProjectorFrame, CameraFrame>& projectorFromCamera)
    : picture_(picture), projector_(projector), map_(projectorFromCamera),
      cameraFromProjector_(projectorFromCamera.inverted()) {
    auto& m = cameraFromProjector_.m;
    for (double& v : m)
        v /= m[8] != 0.0 && &v != &m[8] ? m[8] : 1.0;
    if (m[8] != 0.0) m[8] = 1.0;
    axisAligned_ = m[1] == 0.0 && m[3] == 0.0 && m[6] == 0.0 && m[7] == 0.0 && m[0] > 0.0 && m[4] > 0.0;
    if (!axisAligned_) return;
    identity_ = picture == projector && m[0] == 1.0 && m[4] == 1.0 && m[2] == 0.0 && m[5] == 0.0;
    const auto whole = [](int pixels) { return (pixels + kTile - 1) / kTile * kTile; };
    across_ = taps(whole(projector.width), m[0], m[2]);
    down_ = taps(whole(projector.height), m[4], m[5]);
}

CoverageSampler::CoverageSampler(Size picture, Size projector, const PixelMap& map)
    : CoverageSampler(picture, projector, map.nearest()) {
    if (!map.dense()) return;
    map_ = map;
    dense_ = std::make_shared<const DenseCoverage>(map.dense());
    axisAligned_ = identity_ = false;
}

bool CoverageSampler::isFor(Size picture, Size projector, const PixelMap& map) const {
    const bool sameMap = map.dense() ? map.dense().same(map_.dense()) : map == map_;
    return picture == picture_ && projector == projector_ && sameMap;
}

CoverageSampler::Taps CoverageSampler::taps(int pixels, double scale, double offset) {
    // A box as wide as the projector pixel, at least one camera pixel: at scale 1 and below that is linear
    // interpolation.
    const double width = std::max(1.0, scale);
    Taps taps;
    taps.count = static_cast<int>(std::ceil(width)) + 1;
    for (int i = 0; i < pixels; ++i) {
        const double centre = scale * (i + 0.5) + offset;
        const double from = centre - width / 2, to = centre + width / 2;
        const int first = static_cast<int>(std::floor(from));
        taps.first.push_back(first);
        int given = 0;
        for (int k = 0; k < taps.count; ++k) {
            // The running total is rounded, not each weight: so they sum to 256 exactly.
            const double covered = std::clamp(first + k + 1.0, from, to) - from;
            const int total = k + 1 == taps.count ? 256 : static_cast<int>(std::lround(256.0 * covered / width));
            taps.weights.push_back(static_cast<std::uint16_t>(total - given));
            given = total;
        }
    }
    return taps;
}

PixelRect<CameraFrame> CoverageSampler::source(int column, int row) const {
    if (dense_) return dense_->source(column, row);
    if (axisAligned_) {
        const auto span = [](const Taps& taps, int tile) {
            const auto from = static_cast<std::size_t>(tile) * kTile;
            return std::pair{taps.first[from], taps.first[from + kTile - 1] + taps.count};
        };
        const auto [x0, x1] = span(across_, column);
        const auto [y0, y1] = span(down_, row);
        return {x0, y0, x1, y1};
    }
    const auto& m = cameraFromProjector_.m;
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const int dy : {0, kTile}) {
        for (const int dx : {0, kTile}) {
            const Point<ProjectorFrame> q{static_cast<double>(column * kTile + dx),
                                          static_cast<double>(row * kTile + dy)};
            if (m[6] * q.x + m[7] * q.y + m[8] <= 0.0) return {0, 0, picture_.width, picture_.height};
            const Point<CameraFrame> p = cameraFromProjector_(q);
            x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        }
    }
    // Interpolation reads one more on each side, which depends on its neighbours; clipping keeps a wild registration
    // from asking for the moon.
    const auto whole = [](double v) { return static_cast<int>(std::clamp(std::floor(v), -1e8, 1e8)); };
    return PixelRect<CameraFrame>{whole(x0) - 2, whole(y0) - 2, whole(x1) + 3, whole(y1) + 3};
}

Box<Tile> CoverageSampler::tile(const Mask& mask, int column, int row) const {
    if (identity_) return mask.tile(column, row);
    const PixelRect<CameraFrame> needed = source(column, row);
    const PixelRect<CameraFrame> inside = needed.clipped(picture_);
    if (inside.empty()) return uniformTile(0);
    const std::optional<std::uint8_t> same = uniformOver(mask, inside);
    if (same && (*same == 0 || inside == needed)) return uniformTile(*same);
    if (axisAligned_) return boxed(separable(gatheredOrZero(mask, needed), needed, column, row));
    const MaskPatch patch(mask, inside.grown(2));
    return boxed(dense_ ? dense_->tile(patch, column, row) : projected(patch, column, row));
}

Tile CoverageSampler::separable(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column,
                                int row) const {
    const auto width = static_cast<std::size_t>(at.width()), height = static_cast<std::size_t>(at.height());
    std::vector<std::uint16_t> narrow(static_cast<std::size_t>(kTile) * height);
    const auto countAcross = static_cast<std::size_t>(across_.count), countDown = static_cast<std::size_t>(down_.count);
    const int* firstAcross = &across_.first[static_cast<std::size_t>(column) * kTile];
    const std::uint16_t* weightsAcross = &across_.weights[static_cast<std::size_t>(column) * kTile * countAcross];
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t* line = &pixels[y * width];
        std::uint16_t* to = &narrow[y * kTile];
        for (std::size_t x = 0; x < kTile; ++x) {
            const std::uint8_t* p = line + (firstAcross[x] - at.x0);
            const std::uint16_t* weights = weightsAcross + x * countAcross;
            unsigned sum = 0;
            for (std::size_t k = 0; k < countAcross; ++k)
                sum += unsigned{weights[k]} * p[k];
            to[x] = static_cast<std::uint16_t>(sum);
        }
    }
    Tile tile;
    std::array<unsigned, kTile> sums;
    for (std::size_t y = 0; y < kTile; ++y) {
        const std::size_t pixel = static_cast<std::size_t>(row) * kTile + y;
        const auto first = static_cast<std::size_t>(down_.first[pixel] - at.y0);
        const std::uint16_t* weights = &down_.weights[pixel * countDown];
        sums.fill(1U << 15);
        for (std::size_t k = 0; k < countDown; ++k) {
            const std::uint16_t* line = &narrow[(first + k) * kTile];
            for (std::size_t x = 0; x < kTile; ++x)
                sums[x] += unsigned{weights[k]} * line[x];
        }
        for (std::size_t x = 0; x < kTile; ++x)
            tile.v[y * kTile + x] = static_cast<std::uint8_t>(sums[x] >> 16);
    }
    return tile;
}

Tile CoverageSampler::projected(const MaskPatch& patch, int column, int row) const {
    const auto& m = cameraFromProjector_.m;
    const auto inFront = [&](Point<ProjectorFrame> q) { return m[6] * q.x + m[7] * q.y + m[8] > 0.0; };
    const double cx = column * kTile + kTile / 2.0, cy = row * kTile + kTile / 2.0;
    const Point<CameraFrame> p0 = cameraFromProjector_(Point<ProjectorFrame>{cx, cy});
    const Point<CameraFrame> px = cameraFromProjector_(Point<ProjectorFrame>{cx + 1, cy});
    const Point<CameraFrame> py = cameraFromProjector_(Point<ProjectorFrame>{cx, cy + 1});
    const double scale = std::max(std::hypot(px.x - p0.x, px.y - p0.y), std::hypot(py.x - p0.x, py.y - p0.y));
    const Sampling sampling =
        samplingFor(pointsFor(scale), std::hypot(px.x - p0.x, py.x - p0.x), std::hypot(px.y - p0.y, py.y - p0.y));

    Tile tile;
    for (int top = 0; top < kTile; top += kSquare) {
        for (int left = 0; left < kTile; left += kSquare) {
            const double x0 = column * kTile + left, y0 = row * kTile + top;
            std::uint8_t* to = &tile.at(left, top);
            bool front = true;
            double minX = 1e8, minY = 1e8, maxX = -1e8, maxY = -1e8;
            for (const double dy : {0, kSquare}) {
                for (const double dx : {0, kSquare}) {
                    const Point<ProjectorFrame> q{x0 + dx, y0 + dy};
                    front = front && inFront(q);
                    const auto p = cameraFromProjector_(q);
                    minX = std::min(minX, p.x), maxX = std::max(maxX, p.x);
                    minY = std::min(minY, p.y), maxY = std::max(maxY, p.y);
                }
            }
            const auto whole = [](double v) { return static_cast<int>(std::clamp(std::floor(v), -1e8, 1e8)); };
            const PixelRect<CameraFrame> touched{whole(minX) - 2, whole(minY) - 2, whole(maxX) + 3, whole(maxY) + 3};
            if (const auto same = front ? patch.flatOver(touched) : std::nullopt) {
                for (int y = 0; y < kSquare; ++y)
                    std::memset(to + y * kTile, *same, kSquare);
                continue;
            }
            constexpr int kSide = kSquare + 2;
            constexpr float kFar = -1e6F;  // behind the horizon of the registration: not in the picture
            std::array<float, std::size_t{2} * kSide * kSide> places;
            for (int i = 0; i < kSide * kSide; ++i) {
                const Point<ProjectorFrame> q{x0 + i % kSide - 0.5, y0 + i / kSide - 0.5};
                const auto p = cameraFromProjector_(q);
                const auto at = static_cast<std::size_t>(2 * i);
                places[at] = inFront(q) ? static_cast<float>(p.x) : kFar;
                places[at + 1] = inFront(q) ? static_cast<float>(p.y) : kFar;
            }
            coverSquare(patch, sampling, &places[2 * (kSide + 1)], 2 * kSide, to);
        }
    }
    return tile;
}

}  // namespace ilf
