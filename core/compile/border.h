// Where a sheet of light ends: its border as short straight pieces, and distances to it.
#pragma once

#include <vector>

#include "core/compile/lighting.h"
#include "core/compile/patch.h"

namespace ilf {

/// A straight piece of the line where visible weight is one half.
struct BorderPiece {
    float ax, ay, bx, by;  ///< projector frame
    bool step;             ///< the surfaces on the two sides are farther apart than a depth step
};

/// What the raster shows: 0..255 of each sheet, 255 in all at every pixel.
struct Visible {
    const Document& document;
    const Lighting& light;
    const PixelMap& map;
    const std::vector<TileGrid>& weights;  ///< one per sheet
};

/// The least window of whole squares around `rect`, and the row and column of pixels that closes them.
PixelRect<ProjectorFrame> wholeSquares(PixelRect<ProjectorFrame> rect);

/// The border pieces of `sheet` in `around` (its weights there), a window as wholeSquares gives it.
std::vector<BorderPiece> borderPieces(const Visible& visible, int sheet, const Patch<std::uint8_t>& around);

/// Lowers `squared` (squared distances from pixel centres, at most radius^2 to begin with) to those to the pieces
/// whose `step` is as asked.
void lowerToDistance(const std::vector<BorderPiece>& pieces, bool step, float radius, Patch<float>& squared);

}  // namespace ilf
