// Four corners of something flat in the picture, and the homography between two such quads.
#pragma once

#include <array>
#include <optional>

#include "core/base/geometry.h"

namespace ilf {

/// In order around the thing; a marker's from its own top left, clockwise as it is printed.
using Quad = std::array<Point<CameraFrame>, 4>;

/// How a flat thing moved in the picture: from where it was to where it is.
using Motion = Homography<CameraFrame, CameraFrame>;

/// The homography that takes each corner of `from` to that of `to` exactly; nothing when three corners of either are on
/// a line (to 1e-9 of the quad's size).
std::optional<Motion> motionBetween(const Quad& from, const Quad& to);

Quad cornersOf(const PixelRect<CameraFrame>& box);
Quad moved(const Quad& quad, const Motion& motion);
Point<CameraFrame> middleOf(const Quad& quad);
/// The longest way that a corner goes from `a` to `b`, pixels.
double farthestCorner(const Quad& a, const Quad& b);
/// How much longer lengths about `at` become, on the mean over directions.
double scaleAt(const Motion& motion, Point<CameraFrame> at);
/// Area inside, px^2; negative when the corners run anticlockwise as seen in the picture.
double signedArea(const Quad& quad);
/// The smallest box of whole pixels around it.
PixelRect<CameraFrame> boxAround(const Quad& quad);

}  // namespace ilf
