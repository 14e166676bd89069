// One number for each pixel of a view, kept in the view's own tiles: uniform ones cost nothing.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/perceived/engine_floats.h"
#include "core/perceived/surfaces.h"
#include "core/perceived/view_engine.h"

namespace ilf::view {

inline constexpr int kTileW = ViewTile::kWidth, kTileH = ViewTile::kHeight, kTilePixels = kTileW * kTileH;

using ViewRect = PixelRect<ViewFrame>;

/// Columns and rows of tiles over a view.
struct TileCount {
    int columns = 0, rows = 0;
    int count() const { return columns * rows; }
    ViewRect rect(int tile) const {
        const int x = tile % columns * kTileW, y = tile / columns * kTileH;
        return {x, y, x + kTileW, y + kTileH};
    }
    /// Calls `visit(tile)` for each tile that `pixels` reaches.
    template <class Visit>
    void over(ViewRect pixels, const Visit& visit) const {
        if (pixels.empty()) return;
        const int c0 = std::max(0, pixels.x0) / kTileW, r0 = std::max(0, pixels.y0) / kTileH;
        for (int r = r0; r < rows && r * kTileH < pixels.y1; ++r) {
            for (int c = c0; c < columns && c * kTileW < pixels.x1; ++c)
                visit(r * columns + c);
        }
    }
};
TileCount tileCount(Size size);

/// `work(i)` for 0 <= i < count on one thread, or shared between two.
void shareOut(int count, int threads, const std::function<void(int)>& work);

class TilePlane {
public:
    TilePlane() = default;
    TilePlane(TileCount tiles, float value) : tiles_(tiles), cells_(static_cast<std::size_t>(tiles.count())) {
        for (Cell& cell : cells_)
            cell.uniform = value;
    }
    bool empty() const { return cells_.empty(); }

    /// Takes over `values` (kTilePixels, row by row) and tells which pixels of the view changed.
    ViewRect set(int tile, const float* values);
    ViewRect fill(int tile, float value);

    /// Null where the tile is uniform.
    const float* values(int tile) const { return at(tile).values ? at(tile).values->data() : nullptr; }
    float uniform(int tile) const { return at(tile).uniform; }
    /// Pixels that may be above 0, in the view's frame.
    ViewRect box(int tile) const { return at(tile).box; }
    bool isUniform(int tile, float value) const { return !at(tile).values && at(tile).uniform == value; }
    TileCount tiles() const { return tiles_; }

    /// All of `window` is `value`; beyond the tiles it is 0.
    bool uniformOver(ViewRect window, float value) const;

private:
    struct Cell {
        float uniform = 0.0F;
        std::unique_ptr<AlignedFloats> values;
        ViewRect box;
    };
    const Cell& at(int tile) const { return cells_[static_cast<std::size_t>(tile)]; }
    TileCount tiles_;
    std::vector<Cell> cells_;
};

/// Pixels of `window` where all planes are above 0: a box around them, empty if there are none.
ViewRect litBox(ViewRect window, std::span<const TilePlane* const> planes);

/// The planes' product where it is one number all over `window`.
std::optional<float> evenOver(ViewRect window, std::span<const TilePlane* const> planes);

/// out[y * stride + x] = product of the planes over `window` (`scale` where there are none), 0 beyond the tiles.
void product(float* out, int stride, ViewRect window, std::span<const TilePlane* const> planes);

}  // namespace ilf::view
