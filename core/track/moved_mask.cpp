#include "core/track/moved_mask.h"

#include <algorithm>
#include <cmath>

namespace ilf {

namespace {

/// Camera pixels that a tile's pixels come from, with the bilinear neighbours.
PixelRect<CameraFrame> sourceOf(const PixelRect<CameraFrame>& at, const Motion& back) {
    return boxAround(moved(cornersOf(at), back)).grown(1);
}

/// Whether the picture of the tile passes the motion's horizon: then corners tell nothing.
bool beyondHorizon(const PixelRect<CameraFrame>& at, const Motion& back) {
    const double sign = back.m[8] >= 0.0 ? 1.0 : -1.0;
    return std::ranges::any_of(
        cornersOf(at), [&](const auto& p) { return sign * (back.m[6] * p.x + back.m[7] * p.y + back.m[8]) <= 1e-9; });
}

/// The one value of all pixels in `source` that tiles can tell without looking at them; outside the picture it is 0.
std::optional<std::uint8_t> uniformValue(const Mask& mask, const PixelRect<CameraFrame>& source) {
    const auto inside = source.clipped(mask.size());
    if (inside.empty()) return std::uint8_t{0};
    const bool outside = inside != source;
    const std::uint8_t first = mask.at(inside.x0, inside.y0);
    if (first != 0 && outside) return std::nullopt;
    for (int row = inside.y0 / kTile; row <= (inside.y1 - 1) / kTile; ++row) {
        for (int column = inside.x0 / kTile; column <= (inside.x1 - 1) / kTile; ++column) {
            if (!mask.isUniform(column, row, first)) return std::nullopt;
        }
    }
    return first;
}

/// The mask's pixels within a window, so that the inner loop need not ask for tiles.
struct Window {
    PixelRect<CameraFrame> at;
    std::vector<std::uint8_t> v;

    Window(const Mask& mask, const PixelRect<CameraFrame>& rect)
        : at(rect), v(static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height())) {
        const auto inside = rect.clipped(mask.size());
        if (inside.empty()) return;
        for (int row = inside.y0 / kTile; row <= (inside.y1 - 1) / kTile; ++row) {
            for (int column = inside.x0 / kTile; column <= (inside.x1 - 1) / kTile; ++column) {
                const Tile& tile = *mask.tile(column, row);
                const int x0 = std::max(inside.x0, column * kTile), x1 = std::min(inside.x1, (column + 1) * kTile);
                for (int y = std::max(inside.y0, row * kTile); y < std::min(inside.y1, (row + 1) * kTile); ++y) {
                    const auto* from =
                        &tile.v[static_cast<std::size_t>((y - row * kTile) * kTile + x0 - column * kTile)];
                    std::copy_n(from, x1 - x0, &v[index(x0, y)]);
                }
            }
        }
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - at.y0) * static_cast<std::size_t>(at.width()) +
               static_cast<std::size_t>(x - at.x0);
    }
    float sampled(double x, double y) const {
        const double px = x - 0.5, py = y - 0.5;
        const int ix = static_cast<int>(std::floor(px)), iy = static_cast<int>(std::floor(py));
        if (ix < at.x0 || iy < at.y0 || ix + 1 >= at.x1 || iy + 1 >= at.y1) return 0.0F;
        const auto fx = static_cast<float>(px - ix), fy = static_cast<float>(py - iy);
        const std::size_t i = index(ix, iy), j = i + static_cast<std::size_t>(at.width());
        const auto value = [&](std::size_t k) { return static_cast<float>(v[k]); };
        return (value(i) * (1 - fx) + value(i + 1) * fx) * (1 - fy) + (value(j) * (1 - fx) + value(j + 1) * fx) * fy;
    }
};

/// Samples along a side of each pixel: as many as it has mask pixels across, at most 4.
int samplesFor(const PixelRect<CameraFrame>& at, const Motion& back) {
    const double area = std::abs(signedArea(moved(cornersOf(at), back))) /
                        (static_cast<double>(at.width()) * static_cast<double>(at.height()));
    return std::clamp(static_cast<int>(std::ceil(std::sqrt(area) - 0.25)), 1, 4);
}

Tile warped(const Mask& mask, const PixelRect<CameraFrame>& at, const PixelRect<CameraFrame>& source,
            const Motion& back) {
    const Window window(mask, source.clipped({mask.size().width + 1, mask.size().height + 1}).grown(1));
    const int n = samplesFor(at, back);
    const float share = 1.0F / static_cast<float>(n * n);
    Tile tile;
    for (int y = at.y0; y < at.y1; ++y) {
        for (int x = at.x0; x < at.x1; ++x) {
            float sum = 0.0F;
            for (int sy = 0; sy < n; ++sy) {
                for (int sx = 0; sx < n; ++sx) {
                    const auto from = back(Point<CameraFrame>{x + (sx + 0.5) / n, y + (sy + 0.5) / n});
                    sum += window.sampled(from.x, from.y);
                }
            }
            tile.at(x - at.x0, y - at.y0) = static_cast<std::uint8_t>(sum * share + 0.5F);
        }
    }
    return tile;
}

}  // namespace

Mask moved(const Mask& mask, const Motion& motion, const Mask* before) {
    if (mask.empty() || mask.blank()) return mask;
    const auto covered = mask.coveredPixels();
    const Quad corners = cornersOf(covered);
    if (farthestCorner(corners, moved(corners, motion)) < kLeastMotion_px) return mask;
    if (!(std::abs(motion.determinant()) > 1e-12)) return mask;
    const Motion back = motion.inverted();
    if (before != nullptr && before->size() != mask.size()) before = nullptr;
    Mask result(mask.size());
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            const auto at = mask.pixelsOf(column, row);
            if (beyondHorizon(at, back)) continue;  // the thing is never there
            const auto source = sourceOf(at, back);
            Box<Tile> made;
            if (const auto value = uniformValue(mask, source)) {
                if (*value == 0) continue;
                made = uniformTile(*value);
            } else {
                made = boxed(warped(mask, at, source, back));
            }
            if (before != nullptr && before->tile(column, row) == made) made = before->tile(column, row);
            result.setTile(column, row, std::move(made));
        }
    }
    return result;
}

Point<CameraFrame> middleOf(const Mask& mask) {
    double sum = 0.0, sx = 0.0, sy = 0.0;
    const auto add = [&](double weight, double x, double y) { sum += weight, sx += weight * x, sy += weight * y; };
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            if (mask.isUniform(column, row, 0)) continue;
            const auto at = mask.pixelsOf(column, row);
            if (mask.isUniform(column, row, 255)) {
                add(255.0 * at.width() * at.height(), 0.5 * (at.x0 + at.x1), 0.5 * (at.y0 + at.y1));
                continue;
            }
            const Tile& tile = *mask.tile(column, row);
            for (int y = at.y0; y < at.y1; ++y) {
                for (int x = at.x0; x < at.x1; ++x)
                    add(tile.at(x - at.x0, y - at.y0), x + 0.5, y + 0.5);
            }
        }
    }
    if (sum > 0.0) return {sx / sum, sy / sum};
    return {0.5 * mask.size().width, 0.5 * mask.size().height};
}

}  // namespace ilf
