// The pixels at which a region is seen, tile by tile.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <vector>

#include "core/document/document.h"

namespace ilf {

/// The pixels of one tile at which a region is seen.
struct SeenTile {
    PixelRect<CameraFrame> pixels;
    bool all = false;
    std::bitset<kTile * kTile> some;

    bool at(int x, int y) const {  // picture coordinates
        return all || some[static_cast<std::size_t>((y - pixels.y0) * kTile + (x - pixels.x0))];
    }
};

/// Calls `visit(SeenTile)` for each tile where something is seen of `region`: it covers at least half of the pixel and
/// no active region above it does. The background covers everything.
template <class Visit>
void forEachSeenTile(const Document& document, const Region& region, Visit&& visit) {
    constexpr std::uint8_t kCovers = 128;
    const TileGrid everything = region.id == kBackgroundId ? TileGrid(document.scene.size(), 255) : TileGrid();
    const Mask& mask = region.id == kBackgroundId ? everything : region.mask;
    const std::vector<const Region*> active = activeRegions(document);
    std::vector<const Mask*> above;
    for (const Box<Region>& other : document.regions) {
        if (other->id == region.id) break;
        const bool takesPart = std::find(active.begin(), active.end(), &*other) != active.end();
        if (takesPart && other->mask.size() == mask.size()) above.push_back(&other->mask);
    }
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            const Box<Tile>& own = mask.tile(column, row);
            if (own.same(uniformTile(0))) continue;
            std::vector<const Tile*> hiding;
            bool hidden = false;
            for (const Mask* m : above) {
                const Box<Tile>& t = m->tile(column, row);
                if (t.same(uniformTile(0))) continue;
                hidden = hidden || t.same(uniformTile(255));
                hiding.push_back(&*t);
            }
            if (hidden) continue;
            SeenTile seen;
            seen.pixels = mask.pixelsOf(column, row);
            seen.all = hiding.empty() && own.same(uniformTile(255));
            if (!seen.all) {
                for (int y = 0; y < seen.pixels.height(); ++y) {
                    for (int x = 0; x < seen.pixels.width(); ++x) {
                        bool on = own->at(x, y) >= kCovers;
                        for (const Tile* t : hiding)
                            on = on && t->at(x, y) < kCovers;
                        seen.some[static_cast<std::size_t>(y * kTile + x)] = on;
                    }
                }
                if (seen.some.none()) continue;
            }
            visit(seen);
        }
    }
}

}  // namespace ilf
