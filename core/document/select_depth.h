// Select by depth: a mask grown from a click over the surface that was clicked on.
#pragma once

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/base/tile_grid.h"
#include "core/document/distance.h"

namespace ilf {

struct SurfaceSelection {
    double tolerance = 1.0;    ///< times the bend that ends a surface, 0.1 to 10
    bool colourEdges = false;  ///< strong edges of the picture end it, too: a sheet of paper on a desk
};

/// The connected surface around `seed`. Works in vergence, in which a plane of any slope has no second difference and a
/// depth camera's noise is about the same near and far: the surface ends where the second difference over 6 px of the
/// map smoothed over 5 px, or that over 14 px smoothed over 9 px, exceeds four standard deviations of the noise
/// over the picture (0.004 D at least, and three of a pixel's own standard deviations where those are known), which is
/// so at depth steps and at creases alike. What is too small for the long baseline is judged by the short one alone.
/// From there the surface is continued, along its own slope, to the last pixel that still lies on it. Holes of at most
/// 400 pixels inside it are filled. Edge smoothed by one pixel. Refused: no depth map of the picture's size, a click
/// outside it, and a click where no surface was measured close by. A limit: parts that hang together only by a neck of
/// less than some 30 px beside an edge are surfaces of their own, one click each.
Result<Mask> surfaceAt(const DepthMap& depth, const Picture& picture, Point<CameraFrame> seed,
                       const SurfaceSelection& how = {});

}  // namespace ilf
