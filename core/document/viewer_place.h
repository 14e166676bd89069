// The viewer's pose as an operator types it.
#pragma once

#include "core/document/viewer_pose.h"

namespace ilf {

/// Where the wearer's pupils are, seen from behind the camera, and where they look. All 0: at the camera.
struct ViewerPlace {
    Metre right, down, behind;  ///< of the camera's pinhole, along its axes
    double turned_deg = 0.0;    ///< to the right of the camera's axis
    double tilted_deg = 0.0;    ///< down from it
    bool operator==(const ViewerPlace&) const = default;
};

/// Upright: the eyes' line stays level with the picture's rows.
ViewerPose viewerAt(const ViewerPlace& place, Metre sigma = {});
/// A rotation about the line of sight is not told.
ViewerPlace placeOf(const ViewerPose& viewer);

}  // namespace ilf
