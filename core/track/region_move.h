// Where followed regions are while a sweep plays, so that each slot can show the scene of its own light.
#pragma once

#include <span>
#include <vector>

#include "core/track/moved_mask.h"

namespace ilf {

/// A region's target as it is predicted to move for the length of a sweep: on straight lines, at constant speed.
struct RegionMove {
    RegionId region;
    Quad from;   ///< the target's corners where the region was painted
    Quad now;    ///< at the start of the sweep
    Quad speed;  ///< of the corners, pixels a second; all 0: it stands still
    double fade = 0.0;
    bool operator==(const RegionMove&) const = default;
};

/// At a time from the start of the sweep. A quad that has no homography leaves the region where it was painted.
RegionMotion motionAt(const RegionMove& move, Second intoSweep);
std::vector<RegionMotion> motionsAt(std::span<const RegionMove> moves, Second intoSweep);
bool anyMoves(std::span<const RegionMove> moves);

}  // namespace ilf
