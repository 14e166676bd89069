#include "core/document/stroke.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace ilf {

namespace {

/// The brush's coverage falls from full at `inner` to nothing at `outer`, in pixels from its centre.
struct Falloff {
    explicit Falloff(const Brush& brush) {
        const double soft = brush.radius * (1.0 - brush.hardness);
        const double middle = brush.radius - 0.5 * soft;
        const double half = 0.5 * std::max(1.0, soft);
        inner = std::max(0.0, middle - half);
        outer = middle + half;
        full = 255.0 * brush.opacity;
    }
    /// Coverage at `distance` between inner and outer: 3t^2 - 2t^3, level at both ends.
    std::uint8_t at(double distance) const {
        const double t = std::clamp((outer - distance) / (outer - inner), 0.0, 1.0);
        return static_cast<std::uint8_t>(full * t * t * (3.0 - 2.0 * t) + 0.5);
    }
    double inner = 0.0, outer = 0.0, full = 0.0;
};

/// Working copies of the tiles that a stroke reaches, boxed once at the end.
class Canvas {
public:
    explicit Canvas(const Mask& mask)
        : mask_(mask), tiles_(static_cast<std::size_t>(mask.columns()) * static_cast<std::size_t>(mask.rows())) {}

    const Box<Tile>& before(int column, int row) const { return mask_.tile(column, row); }
    /// True while the tile is still the uniform one.
    bool is(int column, int row, std::uint8_t value) const {
        const auto& tile = tiles_[index(column, row)];
        return tile ? false : mask_.isUniform(column, row, value);
    }
    Tile& tile(int column, int row) {
        auto& tile = tiles_[index(column, row)];
        if (!tile) tile = std::make_unique<Tile>(*mask_.tile(column, row));
        return *tile;
    }
    Mask mask() const {
        Mask result = mask_;
        for (int row = 0; row < mask_.rows(); ++row) {
            for (int column = 0; column < mask_.columns(); ++column) {
                const auto& tile = tiles_[index(column, row)];
                if (tile && *tile != *mask_.tile(column, row)) result.setTile(column, row, boxed(*tile));
            }
        }
        return result;
    }

private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(mask_.columns()) +
               static_cast<std::size_t>(column);
    }
    const Mask& mask_;
    std::vector<std::unique_ptr<Tile>> tiles_;
};

struct Painter {
    PaintMode mode;
    const Tile* keepOut;

    void put(Tile& tile, std::size_t i, std::uint8_t coverage) const {
        std::uint8_t& v = tile.v[i];
        if (mode == PaintMode::erase) {
            v = std::min(v, static_cast<std::uint8_t>(255 - coverage));
            return;
        }
        if (keepOut != nullptr) coverage = std::min(coverage, static_cast<std::uint8_t>(255 - keepOut->v[i]));
        v = std::max(v, coverage);
    }

    /// Puts the dab's share of the tile whose first pixel is (left, top).
    void dab(Tile& tile, int left, int top, Point<CameraFrame> centre, const Falloff& falloff) const {
        const auto fullCoverage = static_cast<std::uint8_t>(falloff.full + 0.5);
        const double cx = centre.x - left - 0.5;
        const int y0 = std::max(0, static_cast<int>(std::floor(centre.y - falloff.outer)) - top);
        const int y1 = std::min(kTile, static_cast<int>(std::ceil(centre.y + falloff.outer)) - top);
        for (int y = y0; y < y1; ++y) {
            const double dy = top + y + 0.5 - centre.y;
            const double outer2 = falloff.outer * falloff.outer - dy * dy;
            if (outer2 <= 0.0) continue;
            const double reach = std::sqrt(outer2);
            const double inner2 = falloff.inner * falloff.inner - dy * dy;
            const int x0 = std::clamp(static_cast<int>(std::ceil(cx - reach)), 0, kTile);
            const int x1 = std::clamp(static_cast<int>(std::floor(cx + reach)) + 1, 0, kTile);
            int full0 = x1;  // the part of the row that is fully covered needs no square root
            int full1 = x1;
            if (inner2 >= 0.0) {
                const double inner = std::sqrt(inner2);
                full0 = std::clamp(static_cast<int>(std::ceil(cx - inner)), x0, x1);
                full1 = std::clamp(static_cast<int>(std::floor(cx + inner)) + 1, full0, x1);
            }
            const auto row = static_cast<std::size_t>(y * kTile);
            const auto ramp = [&](int from, int to) {
                for (int x = from; x < to; ++x) {
                    const double dx = x - cx;
                    put(tile, row + static_cast<std::size_t>(x), falloff.at(std::sqrt(dx * dx + dy * dy)));
                }
            };
            ramp(x0, full0);
            for (int x = full0; x < full1; ++x)
                put(tile, row + static_cast<std::size_t>(x), fullCoverage);
            ramp(full1, x1);
        }
    }
};

}  // namespace

double dabSpacing(const Brush& brush) {
    return std::max(1.0, std::min(0.25 * brush.radius, std::sqrt(2.0 * brush.radius)));
}

std::vector<Dab> spacedDabs(Point<CameraFrame> from, Point<CameraFrame> to, const Brush& brush,
                            std::optional<double>& carry) {
    // Pointer positions that were split differently add up to the same way only to rounding: a dab that is due within
    // this of the end is given now.
    constexpr double kRounding = 1e-6;
    std::vector<Dab> dabs;
    if (!carry) {
        dabs.push_back({from, brush});
        carry = 0.0;
    }
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double spacing = dabSpacing(brush);
    double along = spacing - *carry;
    for (; along <= length + kRounding; along += spacing) {
        const double share = length > 0.0 ? std::min(1.0, along / length) : 1.0;
        dabs.push_back({{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)}, brush});
    }
    carry = length - (along - spacing);
    return dabs;
}

Mask painted(const Mask& mask, const std::vector<Dab>& dabs, PaintMode mode, const Mask* keepOut) {
    Canvas canvas(mask);
    const std::uint8_t done = mode == PaintMode::add ? 255 : 0;
    for (const Dab& dab : dabs) {
        const Falloff falloff(dab.brush);
        const PixelRect<CameraFrame> pixels = reach(dab).clipped(mask.size());
        if (pixels.empty()) continue;
        for (int row = pixels.y0 / kTile; row <= (pixels.y1 - 1) / kTile; ++row) {
            for (int column = pixels.x0 / kTile; column <= (pixels.x1 - 1) / kTile; ++column) {
                if (canvas.is(column, row, done)) continue;
                const Painter painter{mode, keepOut != nullptr ? &*keepOut->tile(column, row) : nullptr};
                painter.dab(canvas.tile(column, row), column * kTile, row * kTile, dab.at, falloff);
            }
        }
    }
    return canvas.mask();
}

PixelRect<CameraFrame> reach(const Dab& dab) {
    const double outer = Falloff(dab.brush).outer;
    // Far outside any picture a double does not fit an int; there a dab reaches nothing anyway.
    const auto whole = [](double v) { return static_cast<int>(std::clamp(v, -1e9, 1e9)); };
    return {whole(std::floor(dab.at.x - outer)), whole(std::floor(dab.at.y - outer)),
            whole(std::ceil(dab.at.x + outer)), whole(std::ceil(dab.at.y + outer))};
}

}  // namespace ilf
