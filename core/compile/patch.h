// Rectangles cut out of tile grids: what a filter needs around the tile it works on.
#pragma once

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/tile_grid.h"

namespace ilf {

/// The one value that every pixel of `rect` has, if the tiles there are all the same uniform one. `rect` must lie
/// inside the grid.
template <class Frame>
std::optional<std::uint8_t> uniformOver(const TileGrid& grid, PixelRect<Frame> rect) {
    const Box<Tile>& first = grid.tile(rect.x0 / kTile, rect.y0 / kTile);
    const std::uint8_t value = first->v[0];
    if (!first.same(uniformTile(value))) return std::nullopt;
    for (int row = rect.y0 / kTile; row <= (rect.y1 - 1) / kTile; ++row)
        for (int column = rect.x0 / kTile; column <= (rect.x1 - 1) / kTile; ++column)
            if (!grid.tile(column, row).same(first)) return std::nullopt;
    return value;
}

/// The pixels of `rect`, row by row; 0 outside the grid.
template <class Frame>
std::vector<std::uint8_t> gatheredOrZero(const TileGrid& grid, PixelRect<Frame> rect) {
    const auto width = static_cast<std::size_t>(rect.width());
    std::vector<std::uint8_t> pixels(width * static_cast<std::size_t>(rect.height()), 0);
    const PixelRect<Frame> inside = rect.clipped(grid.size());
    for (int y = inside.y0; y < inside.y1; ++y) {
        std::uint8_t* line = &pixels[static_cast<std::size_t>(y - rect.y0) * width];
        for (int x = inside.x0; x < inside.x1;) {
            const int until = std::min(inside.x1, (x / kTile + 1) * kTile);
            std::memcpy(line + (x - rect.x0),
                        &grid.tile(x / kTile, y / kTile)->v[static_cast<std::size_t>((y % kTile) * kTile + x % kTile)],
                        static_cast<std::size_t>(until - x));
            x = until;
        }
    }
    return pixels;
}

/// A rectangle of numbers with whole-pixel coordinates.
template <class T>
struct Patch {
    PixelRect<ProjectorFrame> at;
    std::vector<T> v;

    Patch() = default;
    explicit Patch(PixelRect<ProjectorFrame> rect, T value = {})
        : at(rect), v(static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height()), value) {}
    T* row(int y) { return v.data() + static_cast<std::size_t>(y - at.y0) * static_cast<std::size_t>(at.width()); }
    const T* row(int y) const {
        return v.data() + static_cast<std::size_t>(y - at.y0) * static_cast<std::size_t>(at.width());
    }
    T operator()(int x, int y) const { return row(y)[x - at.x0]; }

    /// Bilinear at the centre of pixel (x, y) moved by (dx, dy). Depends on the pixels there and not on where the patch
    /// was cut: position and displacement stay apart, so that no rounding sees the patch's corner.
    float sampled(int x, int y, float dx, float dy) const {
        const int wholeX = static_cast<int>(dx + 4096.0F) - 4096, wholeY = static_cast<int>(dy + 4096.0F) - 4096;
        const float ax = dx - static_cast<float>(wholeX), ay = dy - static_cast<float>(wholeY);
        const T* p = row(y + wholeY) + (x + wholeX - at.x0);
        const T* q = p + at.width();
        const float a = static_cast<float>(p[0]), b = static_cast<float>(p[1]);
        const float c = static_cast<float>(q[0]), d = static_cast<float>(q[1]);
        const float top = a + (b - a) * ax, bottom = c + (d - c) * ax;
        return top + (bottom - top) * ay;
    }
    /// The one value of every pixel of `rect`, which must lie inside, or nothing.
    std::optional<T> flatOver(PixelRect<ProjectorFrame> rect) const {
        const T value = (*this)(rect.x0, rect.y0);
        const std::size_t bytes = static_cast<std::size_t>(rect.width()) * sizeof(T);
        const T* first = row(rect.y0) + (rect.x0 - at.x0);
        // Equal to itself one further on: all equal. Bytes are compared, so that -0 and 0 differ, which costs nothing.
        if (std::memcmp(first, first + 1, bytes - sizeof(T)) != 0) return std::nullopt;
        for (int y = rect.y0 + 1; y < rect.y1; ++y) {
            if (std::memcmp(first, row(y) + (rect.x0 - at.x0), bytes) != 0) return std::nullopt;
        }
        return value;
    }
};

/// The pixels of `rect`; outside the grid the nearest pixel inside repeats, so that the raster's edge is no border.
Patch<std::uint8_t> gathered(const TileGrid& grid, PixelRect<ProjectorFrame> rect);

/// The one value of every pixel of `rect` clipped to the grid, if its tiles are all the same uniform one.
inline std::optional<std::uint8_t> uniformNear(const TileGrid& grid, PixelRect<ProjectorFrame> rect) {
    return uniformOver(grid, rect.clipped(grid.size()));
}

/// Side of the squares that flat light is looked for in. Work inside a tile covers whole squares, so that what a pixel
/// shows does not depend on how much of its tile was worked out anew.
inline constexpr int kSquare = 8;

/// The pixels of tile (column, row), not clipped at the edge.
inline PixelRect<ProjectorFrame> tileRect(int column, int row) {
    return {column * kTile, row * kTile, (column + 1) * kTile, (row + 1) * kTile};
}

}  // namespace ilf
