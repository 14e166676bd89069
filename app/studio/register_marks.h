// What the projector shows for an operator to point at: its own frame, and numbered crosses.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/image.h"

namespace ilf::app {

/// One channel, linear light. The raster's border and corners, numbered as ui::PlaceCorner counts them, on dim grey, so
/// that things in the room can still be seen.
Image<std::uint8_t> framePicture(Size projector);

/// Where crosses are shown, one after the other: far apart first, so that four pairs already tell a homography.
std::vector<Point<ProjectorFrame>> crossPlaces(Size projector);
/// A cross at `at` with its number beside it, counted from 1.
Image<std::uint8_t> crossPicture(Size projector, Point<ProjectorFrame> at, int number);

}  // namespace ilf::app
