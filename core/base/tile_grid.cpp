#include "core/base/tile_grid.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace ilf {

namespace {

bool uniform(const Tile& tile) { return std::memcmp(tile.v.data(), tile.v.data() + 1, tile.v.size() - 1) == 0; }

bool anyAbove0(const Tile& tile) {
    return std::any_of(tile.v.begin(), tile.v.end(), [](std::uint8_t v) { return v != 0; });
}

/// The tile as the rule for the edge wants it, when only `width` x `height` of it lie inside the picture.
Box<Tile> settledAtEdge(Box<Tile> box, int width, int height) {
    const std::uint8_t first = box->v[0];
    if (box.same(uniformTile(first))) return box;
    bool insideUniform = true;
    bool outsideBlack = true;
    for (int y = 0; y < kTile; ++y) {
        for (int x = 0; x < kTile; ++x) {
            const std::uint8_t v = box->at(x, y);
            if (x < width && y < height) {
                insideUniform = insideUniform && v == first;
            } else {
                outsideBlack = outsideBlack && v == 0;
            }
        }
    }
    if (insideUniform) return uniformTile(first);
    if (outsideBlack) return box;
    Tile tile;
    for (int y = 0; y < height; ++y)
        std::copy_n(&box->v[static_cast<std::size_t>(y * kTile)], width, &tile.at(0, y));
    return Box<Tile>(tile);
}

}  // namespace

const Box<Tile>& uniformTile(std::uint8_t value) {
    static const std::array<Box<Tile>, 256> all = [] {
        std::array<Box<Tile>, 256> boxes;
        for (std::size_t v = 0; v < boxes.size(); ++v) {
            Tile tile;
            tile.v.fill(static_cast<std::uint8_t>(v));
            boxes[v] = Box<Tile>(tile);
        }
        return boxes;
    }();
    return all[value];
}

Box<Tile> boxed(const Tile& tile) { return uniform(tile) ? uniformTile(tile.v[0]) : Box<Tile>(tile); }

TileGrid::TileGrid(Size size, std::uint8_t value)
    : size_(size), columns_((size.width + kTile - 1) / kTile), rows_((size.height + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), uniformTile(value)) {}

void TileGrid::setTile(int column, int row, Box<Tile> tile) {
    assert(tile);
    const PixelRect<CameraFrame> inside = pixelsOf(column, row);
    if (inside.width() < kTile || inside.height() < kTile) {
        tile = settledAtEdge(std::move(tile), inside.width(), inside.height());
    }
    tiles_[index(column, row)] = std::move(tile);
}

std::uint8_t TileGrid::at(int x, int y) const {
    if (x < 0 || y < 0 || x >= size_.width || y >= size_.height) return 0;
    return tile(x / kTile, y / kTile)->at(x % kTile, y % kTile);
}

bool TileGrid::blank() const {
    return std::all_of(tiles_.begin(), tiles_.end(),
                       [](const Box<Tile>& t) { return t.same(uniformTile(0)) || !anyAbove0(*t); });
}

PixelRect<CameraFrame> TileGrid::coveredPixels() const {
    PixelRect<CameraFrame> covered;
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            if (isUniform(column, row, 0) || !anyAbove0(*tile(column, row))) continue;
            covered = covered.united(pixelsOf(column, row));
        }
    }
    return covered;
}

void forEachChangedTile(const TileGrid& before, const TileGrid& after, const std::function<void(int, int)>& visit) {
    const bool comparable = before.size() == after.size();
    for (int row = 0; row < after.rows(); ++row) {
        for (int column = 0; column < after.columns(); ++column) {
            if (!comparable || !before.tile(column, row).same(after.tile(column, row))) visit(column, row);
        }
    }
}

Image<std::uint8_t> toImage(const TileGrid& grid) {
    if (grid.empty()) return {};
    const auto width = static_cast<std::size_t>(grid.size().width);
    std::vector<std::uint8_t> pixels(width * static_cast<std::size_t>(grid.size().height));
    for (int row = 0; row < grid.rows(); ++row) {
        for (int column = 0; column < grid.columns(); ++column) {
            const PixelRect<CameraFrame> at = grid.pixelsOf(column, row);
            const Tile& tile = *grid.tile(column, row);
            for (int y = at.y0; y < at.y1; ++y) {
                std::copy_n(&tile.v[static_cast<std::size_t>((y - at.y0) * kTile)], at.width(),
                            &pixels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(at.x0)]);
            }
        }
    }
    return {grid.size(), 1, std::move(pixels)};
}

TileGrid toTiles(const Image<std::uint8_t>& image) {
    if (image.empty()) return {};
    assert(image.channels() == 1);
    TileGrid grid(image.size());
    for (int row = 0; row < grid.rows(); ++row) {
        for (int column = 0; column < grid.columns(); ++column) {
            const PixelRect<CameraFrame> at = grid.pixelsOf(column, row);
            Tile tile;
            for (int y = at.y0; y < at.y1; ++y) {
                std::copy_n(image.row(y) + at.x0, at.width(), &tile.at(0, y - at.y0));
            }
            grid.setTile(column, row, boxed(tile));
        }
    }
    return grid;
}

}  // namespace ilf
