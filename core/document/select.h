// Click-select: a mask grown from a click, by colour flood or by GrabCut on a reduced crop.
#pragma once

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/base/tile_grid.h"

namespace ilf {

/// The connected area around `seed` whose colour differs by at most `tolerance` (0..1 of full scale, per channel, from
/// the seed's own 5x5 mean); edge smoothed by one pixel. A seed outside the picture is an error.
Result<Mask> flooded(const Picture& picture, Point<CameraFrame> seed, double tolerance);

/// The object inside `box`, told from what surrounds it: GrabCut at about a hundred thousand pixels, then refined to
/// the picture's resolution. Takes 0.2-0.7 s: call it on a worker. A box thinner than 8 pixels is an error.
Result<Mask> cutOut(const Picture& picture, PixelRect<CameraFrame> box);

}  // namespace ilf
