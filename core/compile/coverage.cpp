#include "core/compile/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/compile/patch.h"

namespace ilf {

namespace {

/// Above this many camera pixels a projector pixel, supersampling stops growing: 8 x 8 samples a pixel.
constexpr int kMaxSamples = 8;

}  // namespace

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
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const int dy : {0, kTile}) {
        for (const int dx : {0, kTile}) {
            const Point<CameraFrame> p = cameraFromProjector_(
                Point<ProjectorFrame>{static_cast<double>(column * kTile + dx), static_cast<double>(row * kTile + dy)});
            x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        }
    }
    // One more on each side for the interpolation; clipping keeps a wild registration from asking for the moon.
    const auto whole = [](double v) { return static_cast<int>(std::clamp(std::floor(v), -1e8, 1e8)); };
    return PixelRect<CameraFrame>{whole(x0) - 1, whole(y0) - 1, whole(x1) + 2, whole(y1) + 2};
}

Box<Tile> CoverageSampler::tile(const Mask& mask, int column, int row) const {
    if (identity_) return mask.tile(column, row);
    const PixelRect<CameraFrame> needed = source(column, row);
    const PixelRect<CameraFrame> inside = needed.clipped(picture_);
    if (inside.empty()) return uniformTile(0);
    const std::optional<std::uint8_t> same = uniformOver(mask, inside);
    if (same && (*same == 0 || inside == needed)) return uniformTile(*same);
    const PixelRect<CameraFrame> at = axisAligned_ ? needed : inside.grown(2);
    const std::vector<std::uint8_t> pixels = gatheredOrZero(mask, at);
    if (dense_) return boxed(dense_->tile(pixels, at, column, row));
    return boxed(axisAligned_ ? separable(pixels, at, column, row) : supersampled(pixels, at, column, row));
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

Tile CoverageSampler::supersampled(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column,
                                   int row) const {
    const auto& m = cameraFromProjector_.m;
    const double cx = column * kTile + kTile / 2.0, cy = row * kTile + kTile / 2.0;
    const Point<CameraFrame> p0 = cameraFromProjector_(Point<ProjectorFrame>{cx, cy});
    const Point<CameraFrame> px = cameraFromProjector_(Point<ProjectorFrame>{cx + 1, cy});
    const Point<CameraFrame> py = cameraFromProjector_(Point<ProjectorFrame>{cx, cy + 1});
    const double scale = std::max(std::hypot(px.x - p0.x, px.y - p0.y), std::hypot(py.x - p0.x, py.y - p0.y));
    const int n = std::clamp(static_cast<int>(std::ceil(scale - 1e-6)), 1, kMaxSamples);
    const auto width = static_cast<std::size_t>(at.width());
    const auto value = [&](double x, double y) {  // bilinear, 0..255, in camera pixels
        const double fx = x - 0.5 - at.x0, fy = y - 0.5 - at.y0;
        if (!(fx >= 0.0 && fy >= 0.0 && fx < at.width() - 1 && fy < at.height() - 1)) return 0.0;
        const auto ix = static_cast<std::size_t>(fx), iy = static_cast<std::size_t>(fy);
        const double ax = fx - static_cast<double>(ix), ay = fy - static_cast<double>(iy);
        const std::uint8_t* p = &pixels[iy * width + ix];
        return (p[0] * (1 - ax) + p[1] * ax) * (1 - ay) + (p[width] * (1 - ax) + p[width + 1] * ax) * ay;
    };
    Tile tile;
    for (int y = 0; y < kTile; ++y) {
        for (int x = 0; x < kTile; ++x) {
            double sum = 0.0;
            for (int j = 0; j < n; ++j) {
                for (int i = 0; i < n; ++i) {
                    const double qx = column * kTile + x + (i + 0.5) / n, qy = row * kTile + y + (j + 0.5) / n;
                    const double w = m[6] * qx + m[7] * qy + m[8];
                    if (w <= 0.0) continue;  // behind the horizon of the registration: not in the picture
                    sum += value((m[0] * qx + m[1] * qy + m[2]) / w, (m[3] * qx + m[4] * qy + m[5]) / w);
                }
            }
            tile.at(x, y) = static_cast<std::uint8_t>(std::lround(sum / (n * n)));
        }
    }
    return tile;
}

}  // namespace ilf
