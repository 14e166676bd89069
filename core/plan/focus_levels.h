// Which lens powers show all focused objects sharp, as few as possible.
#pragma once

#include <cstddef>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

/// Powers that show one object sharp over its whole extent, nearest to farthest point, within the lens's limits.
/// `low > high`: there are none.
struct FocusWindow {
    Dioptre low, high;
    Dioptre centre;  ///< where the middle of the object is sharpest for a relaxed eye
    bool open() const { return low <= high; }
};
FocusWindow focusWindow(const PlanInput& input, const PlanObject& object);

/// `powers` ascending; `ofWindow[i]` is the level of window i.
struct FocusLevels {
    std::vector<Dioptre> powers;
    std::vector<std::size_t> ofWindow;
};

/// The least number of powers that meets every window (interval stabbing: sorted by their upper ends, each window joins
/// the group whose first upper end it contains). Each power is the point of its group's intersection nearest
/// `preferred`; a camera cannot accommodate, so there it is the one nearest the middle of its objects' own centres.
/// Precondition: all windows are open.
FocusLevels focusLevels(const std::vector<FocusWindow>& windows, Dioptre preferred, bool camera);

}  // namespace ilf
