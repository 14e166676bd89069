// The light of one tile: layers lit so that, magnified and blurred, they add up to even light with the base level.
#pragma once

#include <vector>

#include "core/compile/border.h"

namespace ilf {

/// One tile of every layer, in units of its level's images (255 = full light of the projector).
struct LayerTiles {
    std::vector<Box<Tile>> lit;   ///< one per layer: what the projector lights
    std::vector<Box<Tile>> seen;  ///< linear blending only, one per layer: 255 * m as it appears
    Box<Tile> hard;               ///< above 0 beside a depth step: masks as painted, no blending, no compensation
};

/// Layers over the whole raster.
struct LayerGrids {
    std::vector<TileGrid> lit, seen;
    TileGrid hard;
};

/// What of a tile is to be worked out: whole squares of kSquare pixels. The rest is taken from `before`.
struct TilePart {
    int column = 0, row = 0;
    PixelRect<ProjectorFrame> pixels;
};

/// Works out a part of a tile; `before` holds the rest.
LayerTiles layerTiles(const Visible& visible, const TilePart& part, const LayerGrids& before);

/// One tile of the image of every level, 255 = full light, from the layers around it. The images as they were before.
std::vector<Box<Tile>> levelTiles(const Lighting& light, const LayerGrids& layers, const TilePart& part,
                                  const std::vector<TileGrid>& imagesBefore);

}  // namespace ilf
