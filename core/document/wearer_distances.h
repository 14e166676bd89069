// Depth as the camera measured it, turned into distances from the wearer's lens.
#pragma once

#include "core/document/distance.h"
#include "core/document/viewer_pose.h"
#include "core/document/wearer.h"

namespace ilf {

/// What is nearer to the lens than this, or behind it, is a hole.
inline constexpr Metre kNearestDepth = 10.0_mm;

/// Every pixel's point in the room (its ray through the camera, lens distortion undone, at the measured depth) is seen
/// from the viewer's pose: d_oE = z_viewer - d_Ee, along the lens axes (optics.md 1.5: d_Ee runs from the lens to the
/// entrance pupil). With the viewer at the camera: d_oE = z_camera - d_Ee, since the picture is the view from the
/// pupil. Sigma: the depth's own along the lens axis, and the viewer's, added in squares. Nearer than kNearestDepth or
/// farther than kFarthestDistance: a hole. Precondition: `measured.camera` has the picture's size where the pose turns.
DepthMap wearerDistances(const MeasuredDepth& measured, const ViewerPose& viewer, const Wearer& wearer);

}  // namespace ilf
