// How near and how far a depth map is over what is seen of a region.
#pragma once

#include <optional>

#include "core/document/document.h"

namespace ilf {

/// As `distanceRange` says of a depth map, without the region's tolerance.
struct DepthSeen {
    Metre nearest, farthest;
    double holes = 0.0;
    Metre sigma;
};
/// Nothing: no depth map of the picture's size, or only holes.
std::optional<DepthSeen> depthSeen(const Document& document, const Region& region);

}  // namespace ilf
