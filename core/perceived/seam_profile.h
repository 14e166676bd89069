// The seam at the cursor: light across the nearest border as an eye receives it, before and after blending.
#pragma once

#include <optional>
#include <vector>

#include "core/compile/compile.h"

namespace ilf {

/// One eye's profile. 1 = the light a region has away from borders.
struct EyeProfile {
    std::vector<float> before;  ///< hard masks
    std::vector<float> after;   ///< as compiled
    double worstWeberBefore = 0.0;
    double worstWeberAfter = 0.0;  ///< largest |I - 1| along the profile
};

struct SeamProfile {
    Point<CameraFrame> at;      ///< where the profile crosses the border
    double nx = 1.0, ny = 0.0;  ///< unit normal, from the blurred side outwards
    RegionId blurred, other;
    std::vector<float> millimetres;  ///< positions along the normal across the surface, 0 = painted border
    EyeProfile left, right;
    /// (s - 1) |(x - c) n| of the eye where it is larger: the gap or overlap along the normal without blending.
    double seamWidth_mm = 0.0;
    bool gap = false;        ///< true: dark without blending; false: bright
    bool depthStep = false;  ///< one surface stands before the other here: not blended, what shows is its outline
};

/// The profile across the border of a blurred or neutral region (towards a region lit at another level) nearest to
/// `cursor` within `withinPixels`; nothing when there is no such border. The sign of the seam comes from the geometry
/// (see scheduling F5), never from the paper's sentence. Worked out on a patch around the border, for an even white
/// surface and an eye that looks at the blurred one; ends at the picture's edge.
std::optional<SeamProfile> seamProfile(const Compiled& compiled, Point<CameraFrame> cursor, double withinPixels);

}  // namespace ilf
