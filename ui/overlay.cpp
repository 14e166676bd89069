#include "ui/overlay.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace ilf::ui {

namespace {

struct Ink {
    std::uint8_t r, g, b;
};

Ink inkOf(Look look) {
    switch (look) {
    case Look::focus:
        return {0x4F, 0xA3, 0xFF};
    case Look::blur:
        return {0xFF, 0x9F, 0x45};
    case Look::neutral:
        break;
    }
    return {0xB4, 0xBD, 0xC9};
}

/// Marks scale with the picture: one unit is a thousandth of its longer side, at least a pixel.
int unit(Size size) { return std::max(1, (std::max(size.width, size.height) + 500) / 1000); }
/// How far an edge reaches, in pixels.
int edgeWidth(Size size) { return 2 * unit(size); }

constexpr int kNone = -1;
constexpr int kMaxReach = kTile;  // a picture 32 times as wide as a tile's reach is over the 100 megapixel limit

/// Which active region owns each pixel of the tile and of a border of `reach` pixels around it.
struct Owners {
    int reach, side;
    std::vector<std::int16_t> owner;

    Owners(const std::vector<const Region*>& regions, Size size, int column, int row, int border)
        : reach(border), side(kTile + 2 * border),
          owner(static_cast<std::size_t>(side * side), static_cast<std::int16_t>(kNone)) {
        const int x0 = column * kTile - reach, y0 = row * kTile - reach;
        for (std::size_t k = regions.size(); k-- > 0;) {
            const Mask& mask = regions[k]->mask;
            if (mask.empty()) continue;
            for (int tileY = floorDiv(y0); tileY <= floorDiv(y0 + side - 1); ++tileY) {
                for (int tileX = floorDiv(x0); tileX <= floorDiv(x0 + side - 1); ++tileX) {
                    if (tileX < 0 || tileY < 0 || tileX >= mask.columns() || tileY >= mask.rows()) continue;
                    if (mask.isUniform(tileX, tileY, 0)) continue;
                    stamp(*mask.tile(tileX, tileY), tileX * kTile, tileY * kTile, x0, y0, size, static_cast<int>(k));
                }
            }
        }
    }

    static int floorDiv(int v) { return v >= 0 ? v / kTile : -((-v + kTile - 1) / kTile); }

    void stamp(const Tile& tile, int left, int top, int x0, int y0, Size size, int region) {
        const int fromX = std::max(left, x0), toX = std::min({left + kTile, x0 + side, size.width});
        const int fromY = std::max(top, y0), toY = std::min({top + kTile, y0 + side, size.height});
        for (int y = fromY; y < toY; ++y) {
            std::int16_t* row = &owner[static_cast<std::size_t>((y - y0) * side)];
            for (int x = fromX; x < toX; ++x)
                row[x - x0] = tile.at(x - left, y - top) >= 128 ? static_cast<std::int16_t>(region) : row[x - x0];
        }
    }

    int at(int x, int y) const { return owner[index(x, y)]; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>((y + reach) * side + x + reach); }

    /// For each pixel of the tile, whether one within `reach` along the axes or the diagonals belongs to somebody else.
    /// Offset by offset, so that a row is compared at once: this runs for every tile a dab touches.
    std::array<std::uint8_t, kTile * kTile> edges() const {
        std::array<std::uint8_t, kTile * kTile> on{};
        const auto compare = [&](int dx, int dy) {
            for (int y = 0; y < kTile; ++y) {
                const std::int16_t* mine = &owner[index(0, y)];
                const std::int16_t* other = &owner[index(dx, y + dy)];
                std::uint8_t* row = &on[static_cast<std::size_t>(y) * kTile];
                for (int x = 0; x < kTile; ++x)
                    row[x] = static_cast<std::uint8_t>(row[x] | (mine[x] != other[x] ? 1 : 0));
            }
        };
        const int diagonal = std::max(1, reach * 7 / 10);
        for (int step = 1; step <= reach; ++step) {
            for (const auto& [dx, dy] :
                 {std::pair(step, 0), std::pair(-step, 0), std::pair(0, step), std::pair(0, -step)})
                compare(dx, dy);
            if (step > diagonal) continue;
            for (const int dx : {-step, step}) {
                compare(dx, -step);
                compare(dx, step);
            }
        }
        return on;
    }
};

bool hasPixels(const Document& document) { return !document.regions.empty() && document.scene.picture; }

/// What, besides its mask, decides how a region is drawn.
struct Drawn {
    RegionId id;
    Look look;
    bool operator==(const Drawn&) const = default;
};
std::vector<Drawn> drawnOrder(const std::vector<const Region*>& regions) {
    std::vector<Drawn> order;
    for (const Region* region : regions)
        order.push_back({region->id, region->look});
    return order;
}

}  // namespace

OverlayTile overlayTile(const Document& document, const RegionId& selected, int column, int row) {
    OverlayTile out{};
    if (!hasPixels(document)) return out;
    const Size size = document.scene.size();
    const std::vector<const Region*> regions = activeRegions(document);
    const int u = unit(size), reach = std::min(edgeWidth(size), kMaxReach);
    const Owners owners(regions, size, column, row, reach);
    if (std::all_of(owners.owner.begin(), owners.owner.end(), [](int o) { return o == kNone; })) return out;

    const auto edges = owners.edges();

    const int hatchPeriod = 14 * u, hatchWidth = 2 * u, dotPeriod = 8 * u;
    for (int y = 0; y < kTile; ++y) {
        int phase = (column * kTile + row * kTile + y) % hatchPeriod;  // of the pixel's diagonal
        for (int x = 0; x < kTile; ++x, phase = phase + 1 == hatchPeriod ? 0 : phase + 1) {
            const int owner = owners.at(x, y);
            if (owner == kNone) continue;
            const Region& region = *regions[static_cast<std::size_t>(owner)];
            const bool bright = region.id == selected;
            const int px = column * kTile + x, py = row * kTile + y;
            double alpha = 0.0;
            if (edges[static_cast<std::size_t>(y * kTile + x)] != 0) {
                // Dots along either axis keep a dotted line dotted whichever way the border runs.
                const bool dot =
                    ((px + py) % dotPeriod) < dotPeriod / 2 && ((px - py + (1 << 20)) % dotPeriod) < dotPeriod * 3 / 4;
                const bool on = region.look != Look::focus || dot;
                alpha = on ? (bright ? 1.0 : 0.75) : 0.12;
            } else if (region.look == Look::blur) {
                alpha = phase < hatchWidth ? (bright ? 0.6 : 0.42) : (bright ? 0.05 : 0.0);
            } else {
                alpha = bright ? 0.06 : 0.0;
            }
            if (alpha == 0.0) continue;
            const Ink ink = inkOf(region.look);
            std::uint8_t* pixel = &out[static_cast<std::size_t>((y * kTile + x) * 4)];
            pixel[0] = ink.r;
            pixel[1] = ink.g;
            pixel[2] = ink.b;
            pixel[3] = static_cast<std::uint8_t>(alpha * 255.0 + 0.5);
        }
    }
    return out;
}

std::vector<std::pair<int, int>> overlayTilesThatDiffer(const OverlaySubject& before, const OverlaySubject& after) {
    const Size size = after.document.scene.size();
    const int columns = (size.width + kTile - 1) / kTile, rows = (size.height + kTile - 1) / kTile;
    std::vector<std::pair<int, int>> all;
    std::vector<char> changed(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    const auto mark = [&](int column, int row) {
        // An edge reaches into the neighbours.
        for (int y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y) {
            for (int x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x) {
                changed[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] =
                    1;
            }
        }
    };
    const auto markCovered = [&](const Mask& mask) {
        for (int row = 0; row < mask.rows(); ++row) {
            for (int column = 0; column < mask.columns(); ++column) {
                if (!mask.isUniform(column, row, 0)) mark(column, row);
            }
        }
    };
    const auto regionsBefore = activeRegions(before.document), regionsAfter = activeRegions(after.document);
    if (before.document.scene.size() != size) {
        std::fill(changed.begin(), changed.end(), 1);
    } else if (drawnOrder(regionsBefore) == drawnOrder(regionsAfter)) {
        for (std::size_t i = 0; i < regionsAfter.size(); ++i) {
            forEachChangedTile(regionsBefore[i]->mask, regionsAfter[i]->mask, mark);
            const RegionId& id = regionsAfter[i]->id;
            if ((before.selected == id) != (after.selected == id)) markCovered(regionsAfter[i]->mask);
        }
    } else {
        for (const Region* region : regionsBefore)
            markCovered(region->mask);
        for (const Region* region : regionsAfter)
            markCovered(region->mask);
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (changed[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(column)] != 0) {
                all.emplace_back(column, row);
            }
        }
    }
    return all;
}

}  // namespace ilf::ui
