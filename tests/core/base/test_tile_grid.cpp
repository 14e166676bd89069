#include "core/base/tile_grid.h"

#include <set>

#include "tests/support/law.h"

namespace ilf {

namespace {

Image<std::uint8_t> anyImage() {
    const Size size{*rc::gen::inRange(1, 200), *rc::gen::inRange(1, 200)};
    // Few values, so that uniform tiles and uniform edges occur.
    auto pixels = *rc::gen::container<std::vector<std::uint8_t>>(static_cast<std::size_t>(size.width) *
                                                                     static_cast<std::size_t>(size.height),
                                                                 rc::gen::element<std::uint8_t>(0, 255, 7));
    const int flatFrom = *rc::gen::inRange(0, size.height + 1);
    std::fill(pixels.begin() + static_cast<std::ptrdiff_t>(flatFrom) * size.width, pixels.end(), std::uint8_t{255});
    return {size, 1, std::move(pixels)};
}

}  // namespace

TEST_CASE("tiles: a picture comes back from its tiles") {
    law("toImage(toTiles(i)) == i", [] {
        const auto image = anyImage();
        const TileGrid grid = toTiles(image);
        RC_ASSERT(toImage(grid) == image);
        for (int i = 0; i < 20; ++i) {
            const int x = *rc::gen::inRange(0, image.width());
            const int y = *rc::gen::inRange(0, image.height());
            RC_ASSERT(grid.at(x, y) == image.at(x, y));
        }
    });
}

TEST_CASE("tiles: equal pixels are equal grids, whatever lay beyond the edge") {
    law("setTile settles what lies beyond the edge", [] {
        const auto image = anyImage();
        const TileGrid grid = toTiles(image);
        TileGrid scribbled(grid.size());
        const auto noise = *rc::gen::inRange<int>(0, 256);
        for (int row = 0; row < grid.rows(); ++row) {
            for (int column = 0; column < grid.columns(); ++column) {
                Tile tile = *grid.tile(column, row);
                const auto inside = grid.pixelsOf(column, row);
                for (int y = 0; y < kTile; ++y) {
                    for (int x = 0; x < kTile; ++x) {
                        if (x >= inside.width() || y >= inside.height()) {
                            tile.at(x, y) = static_cast<std::uint8_t>(noise);
                        }
                    }
                }
                scribbled.setTile(column, row, boxed(tile));
            }
        }
        RC_ASSERT(scribbled == grid);
    });
}

TEST_CASE("tiles: a full mask is uniform tiles up to its edge, and 0 outside the picture") {
    const TileGrid full({100, 70}, 255);
    CHECK(full.columns() == 2);
    CHECK(full.rows() == 2);
    CHECK(full.isUniform(1, 1, 255));
    CHECK(full.at(99, 69) == 255);
    CHECK(full.at(100, 69) == 0);
    CHECK(full.at(-1, 0) == 0);
    CHECK(full.coveredPixels() == PixelRect<CameraFrame>{0, 0, 100, 70});
    CHECK(full == toTiles(toImage(full)));
    CHECK_FALSE(full.blank());
    CHECK(TileGrid({100, 70}).blank());
    CHECK(TileGrid({100, 70}).coveredPixels().empty());
    CHECK(TileGrid().blank());
    CHECK(toImage(TileGrid()).empty());
}

TEST_CASE("tiles: uniform tiles are one shared box, however they came to be") {
    Tile tile;
    tile.v.fill(42);
    CHECK(boxed(tile).same(uniformTile(42)));
    tile.at(63, 63) = 41;
    CHECK_FALSE(boxed(tile).same(uniformTile(42)));

    TileGrid grid({70, 64});
    Tile half;  // only the six columns inside the picture are 9
    for (int y = 0; y < kTile; ++y) {
        for (int x = 0; x < 6; ++x)
            half.at(x, y) = 9;
    }
    grid.setTile(1, 0, boxed(half));
    CHECK(grid.isUniform(1, 0, 9));
}

TEST_CASE("tiles: what changed is told by the boxes, and a changed tile leaves the others shared") {
    const TileGrid before({300, 200}, 3);
    TileGrid after = before;
    Tile tile;
    tile.at(1, 1) = 200;
    after.setTile(2, 1, boxed(tile));
    std::set<std::pair<int, int>> changed;
    forEachChangedTile(before, after, [&](int column, int row) { changed.insert({column, row}); });
    CHECK(changed == std::set<std::pair<int, int>>{{2, 1}});
    CHECK(after.tile(0, 0).same(before.tile(0, 0)));

    int all = 0;
    forEachChangedTile(TileGrid({10, 10}), after, [&](int, int) { ++all; });
    CHECK(all == after.columns() * after.rows());
}

}  // namespace ilf
