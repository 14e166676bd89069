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
    : picture_(picture), cameraFromProjector_(projectorFromCamera.inverted()) {
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

std::vector<CoverageSampler::Tap> CoverageSampler::taps(int count, double scale, double offset) {
    std::vector<Tap> all(static_cast<std::size_t>(count));
    // A box as wide as the projector pixel, at least one camera pixel: at scale 1 and below that is linear
    // interpolation.
    const double width = std::max(1.0, scale);
    for (int i = 0; i < count; ++i) {
        const double centre = scale * (i + 0.5) + offset;
        const double from = centre - width / 2, to = centre + width / 2;
        Tap& tap = all[static_cast<std::size_t>(i)];
        tap.first = static_cast<int>(std::floor(from));
        int left = 256;
        for (int x = tap.first; x < to; ++x) {
            const double covered = std::min(to, x + 1.0) - tap.first;  // running total: the weights sum to 256 exactly
            const double before = std::max(from - tap.first, 0.0);
            const int total = static_cast<int>(std::lround(256.0 * (covered - before) / width));
            const int weight = total - (256 - left);
            tap.weights.push_back(static_cast<std::uint16_t>(weight));
            left -= weight;
        }
        tap.weights.back() = static_cast<std::uint16_t>(tap.weights.back() + left);
    }
    return all;
}

PixelRect<CameraFrame> CoverageSampler::source(int column, int row) const {
    if (axisAligned_) {
        const auto span = [](const std::vector<Tap>& taps, int tile) {
            const Tap& first = taps[static_cast<std::size_t>(tile * kTile)];
            const Tap& last = taps[static_cast<std::size_t>(tile * kTile + kTile - 1)];
            return std::pair{first.first, last.first + static_cast<int>(last.weights.size())};
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
    return boxed(axisAligned_ ? separable(pixels, at, column, row) : supersampled(pixels, at, column, row));
}

Tile CoverageSampler::separable(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column,
                                int row) const {
    const auto width = static_cast<std::size_t>(at.width()), height = static_cast<std::size_t>(at.height());
    std::vector<std::uint16_t> narrow(static_cast<std::size_t>(kTile) * height);
    for (int x = 0; x < kTile; ++x) {
        const Tap& tap = across_[static_cast<std::size_t>(column * kTile + x)];
        const auto first = static_cast<std::size_t>(tap.first - at.x0);
        for (std::size_t y = 0; y < height; ++y) {
            const std::uint8_t* p = &pixels[y * width + first];
            unsigned sum = 0;
            for (std::size_t k = 0; k < tap.weights.size(); ++k)
                sum += unsigned{tap.weights[k]} * p[k];
            narrow[y * kTile + static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(sum);
        }
    }
    Tile tile;
    std::array<unsigned, kTile> sums;
    for (int y = 0; y < kTile; ++y) {
        const Tap& tap = down_[static_cast<std::size_t>(row * kTile + y)];
        const auto first = static_cast<std::size_t>(tap.first - at.y0);
        sums.fill(1U << 15);
        for (std::size_t k = 0; k < tap.weights.size(); ++k) {
            const std::uint16_t* line = &narrow[(first + k) * kTile];
            for (std::size_t x = 0; x < kTile; ++x)
                sums[x] += unsigned{tap.weights[k]} * line[x];
        }
        for (std::size_t x = 0; x < kTile; ++x)
            tile.v[static_cast<std::size_t>(y) * kTile + x] = static_cast<std::uint8_t>(sums[x] >> 16);
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
