// Regions on their way from one look to another: both are planned for, so that their light can go over evenly.
#pragma once

#include "core/document/document.h"

namespace ilf {

/// In the plan, the region of that id in the look it fades to.
RegionId fadedId(const RegionId& id);

/// Partly its own look, partly the other.
inline bool fading(const Region& region) { return region.fade && region.fade->share > 0.0 && region.fade->share < 1.0; }
/// The other look alone.
inline bool faded(const Region& region) { return region.fade && region.fade->share >= 1.0; }

}  // namespace ilf
