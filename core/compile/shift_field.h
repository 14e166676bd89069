// How one layer is displaced over one tile.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/compile/lighting.h"
#include "core/compile/patch.h"

namespace ilf {

inline Shift mixed(Shift a, Shift b, float t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

/// One of a layer's displacements over a tile, linear between its corners.
class ShiftField {
public:
    ShiftField(const Lighting& light, const Layer& layer, Shift LayerNode::* which, int column, int row)
        : column_(column), row_(row), a_(light.node(layer, column, row).*which),
          b_(light.node(layer, column + 1, row).*which), c_(light.node(layer, column, row + 1).*which),
          d_(light.node(layer, column + 1, row + 1).*which) {}

    /// Along the row of pixel centres y.
    class Row {
    public:
        Row(Shift from, Shift to, int x0)
            : from_(from), slope_{(to.x - from.x) / kTile, (to.y - from.y) / kTile}, x0_(x0) {}
        Shift at(int x) const {
            const float u = static_cast<float>(x - x0_) + 0.5F;
            return {from_.x + slope_.x * u, from_.y + slope_.y * u};
        }

    private:
        Shift from_, slope_;
        int x0_;
    };
    Row row(int y) const {
        const float v = (static_cast<float>(y - row_ * kTile) + 0.5F) / kTile;
        return {mixed(a_, c_, v), mixed(b_, d_, v), column_ * kTile};
    }
    /// At the centre of a pixel of the raster.
    Shift at(int x, int y) const { return row(y).at(x); }
    /// The largest displacement in the tile, whole pixels, either way.
    int reach() const {
        float most = 0.0F;
        for (const Shift s : {a_, b_, c_, d_})
            most = std::max({most, std::abs(s.x), std::abs(s.y)});
        return static_cast<int>(most) + 1;
    }
    /// All pixels that interpolation at the displaced pixels of `square` touches.
    PixelRect<ProjectorFrame> touched(PixelRect<ProjectorFrame> square) const {
        PixelRect<ProjectorFrame> all;
        for (const int y : {square.y0, square.y1 - 1}) {
            for (const int x : {square.x0, square.x1 - 1}) {
                const Shift s = at(x, y);
                const int px = x + static_cast<int>(s.x + 4096.0F) - 4096,
                          py = y + static_cast<int>(s.y + 4096.0F) - 4096;
                all = all.united({px - 1, py - 1, px + 3, py + 3});  // one to spare: rounding differs inside
            }
        }
        return all;
    }

private:
    int column_, row_;
    Shift a_, b_, c_, d_;
};

/// Calls `visit(square)` for each square of `part`.
template <class Visit>
void forEachSquare(PixelRect<ProjectorFrame> part, Visit&& visit) {
    for (int y = part.y0; y < part.y1; y += kSquare)
        for (int x = part.x0; x < part.x1; x += kSquare)
            visit(PixelRect<ProjectorFrame>{x, y, x + kSquare, y + kSquare});
}

}  // namespace ilf
