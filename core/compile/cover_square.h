// Inside the samplers: a mask around a tile, ready to be averaged over projector pixels, compiled for several
// processors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/tile_grid.h"

namespace ilf {

/// A mask's values are averages over camera pixels, and interpolating spreads them as much again: together by 2/12 of a
/// pixel squared along each axis, which makes borders wider than they were painted. A second difference takes that
/// back: 12 v - (sum of the four neighbours - 4 v), twelve times too large so that it stays whole. What is then
/// averaged over an area is spread by that area alone. Where there is no border nothing changes.
struct MaskPatch {
    /// Zero outside the mask. `rect`: two pixels more on each side than is sampled.
    MaskPatch(const Mask& mask, PixelRect<CameraFrame> rect);

    /// The one value of all pixels that `touched` shares with the patch, or nothing.
    std::optional<std::uint8_t> flatOver(PixelRect<CameraFrame> touched) const;

    PixelRect<CameraFrame> at;
    std::vector<std::uint8_t> plain;
    /// Twelve times the sharpened coverage in the lower 16 bits, that of the pixel to the right in the upper ones: one
    /// load for both.
    std::vector<std::int32_t> pairs;
};

/// How a projector pixel is averaged: over n x n points of its area, each standing for a box about it in the picture
/// that is no larger than a camera pixel; the boxes tile the area. One of a camera pixel is linear interpolation.
struct Sampling {
    int points = 1;              ///< n
    float overX = 1, overY = 1;  ///< one over the sides of the boxes
};

/// For projector pixels that reach over so many camera pixels along x and y (roots of their steps' summed squares).
Sampling samplingFor(int points, double reachX, double reachY);

/// How many points along a side a projector pixel of so many camera pixels needs.
int pointsFor(double scale);

/// Covers 8 x 8 projector pixels, whose centres lie in the picture at `places` (x, y, x, y, ...; a row has `stride`
/// numbers). One more place on every side is read: a pixel's area is spanned by how the map goes on beside it, on the
/// smoother side, so that across a depth step it stays on its own surface. `to`: rows kTile apart.
void coverSquare(const MaskPatch& patch, const Sampling& sampling, const float* places, std::ptrdiff_t stride,
                 std::uint8_t* to);

}  // namespace ilf
