// An 8-bit picture as a grid of immutable shared 64x64 tiles: cheap copies, cheap "what changed".
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/box.h"
#include "core/base/geometry.h"
#include "core/base/image.h"

namespace ilf {

/// Pixels along a tile's side. 4 KB a tile: a dab of radius 40 px copies four to nine of them.
inline constexpr int kTile = 64;

/// One tile's values, row-major.
struct Tile {
    std::array<std::uint8_t, kTile * kTile> v{};
    bool operator==(const Tile&) const = default;
    std::uint8_t& at(int x, int y) { return v[static_cast<std::size_t>(y * kTile + x)]; }
    std::uint8_t at(int x, int y) const { return v[static_cast<std::size_t>(y * kTile + x)]; }
};

/// The tile of all `value`; the same box for every caller, so uniform tiles compare by pointer.
const Box<Tile>& uniformTile(std::uint8_t value);
/// Boxes `tile`, giving the shared box when it is uniform.
Box<Tile> boxed(const Tile& tile);

/// Values 0..255 over `size` pixels. Copies share tiles; changing one tile leaves all others shared.
///
/// Tiles at the right and lower edge reach beyond the picture. What lies there is never shown, and follows one rule, so
/// that equal pictures are equal grids and uniform tiles stay shared: a tile whose pixels inside the picture all have
/// one value is the uniform tile of that value, beyond the edge too; in any other tile what lies beyond the edge is 0.
/// `setTile` sees to it. So code that works on whole tiles (maximum, 255 - v, a table) needs no thought for the edge;
/// code that counts or measures pixels must clip to `pixelsOf`.
class TileGrid {
public:
    TileGrid() = default;
    explicit TileGrid(Size size, std::uint8_t value = 0);

    Size size() const { return size_; }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool empty() const { return tiles_.empty(); }

    const Box<Tile>& tile(int column, int row) const { return tiles_[index(column, row)]; }
    /// Precondition: `tile` is not empty. Keeps the box itself unless the rule for the edge asks for another; give
    /// tiles that may be uniform as `boxed(tile)`.
    void setTile(int column, int row, Box<Tile> tile);
    /// The tile's pixels inside the picture.
    PixelRect<CameraFrame> pixelsOf(int column, int row) const {
        return PixelRect<CameraFrame>{column * kTile, row * kTile, (column + 1) * kTile, (row + 1) * kTile}.clipped(
            size_);
    }
    bool isUniform(int column, int row, std::uint8_t value) const { return tile(column, row).same(uniformTile(value)); }
    /// The value of a pixel; 0 outside the picture.
    std::uint8_t at(int x, int y) const;

    /// True if no pixel is above 0.
    bool blank() const;
    /// The smallest rectangle of whole tiles that holds every pixel above 0, clipped to the picture.
    PixelRect<CameraFrame> coveredPixels() const;

    bool operator==(const TileGrid& other) const = default;

private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    Size size_;
    int columns_ = 0, rows_ = 0;
    std::vector<Box<Tile>> tiles_;
};

/// Calls `visit(column, row)` for every tile whose box differs between grids of one size; for every tile of `after`
/// when the sizes differ. Boxes that differ may hold equal values.
void forEachChangedTile(const TileGrid& before, const TileGrid& after, const std::function<void(int, int)>& visit);

/// One-channel picture, 0..255, of the grid (empty for an empty grid), and back. `image` must have one channel.
Image<std::uint8_t> toImage(const TileGrid& grid);
TileGrid toTiles(const Image<std::uint8_t>& image);

/// Coverage of a region over the picture, camera frame, 0 = outside, 255 = inside.
using Mask = TileGrid;

}  // namespace ilf
