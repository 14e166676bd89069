// Where the three anchors of a region's plane go.
#pragma once

#include <array>

#include "core/document/document.h"

namespace ilf {

/// A triangle over what is seen of the region, or over its mask where nothing is, or over the picture.
std::array<Point<CameraFrame>, 3> planeAnchors(const Document& document, const Region& region);

}  // namespace ilf
