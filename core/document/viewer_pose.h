// Where the wearer stands to the camera, and depth as a camera, a scan or a scene gives it.
#pragma once

#include <string>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/registration/pinhole.h"

namespace ilf {

/// Default: the wearer's pupil at the camera's pinhole, looking along the camera's axis.
struct ViewerPose {
    Pose<ViewerSpace, CameraSpace> viewerFromCamera;
    Metre sigma = 0.0_m;                   ///< of the wearer's place along the view, one standard deviation
    std::string source = "at the camera";  ///< for the operator
    bool operator==(const ViewerPose&) const = default;
};

/// Depth of the picture's pixels as it was measured: along the camera's axis, from its pinhole, in metres.
struct MeasuredDepth {
    Image<float> metres;     ///< the picture's size; 0: a hole
    Image<float> sigma;      ///< one standard deviation, metres; may be empty: not known
    Pinhole camera;          ///< of the picture
    Metre step = 0.0_m;      ///< one step of a file of whole numbers; 0: it was in metres
    std::string source;      ///< file, scan or scene; for the operator
    std::string provenance;  ///< simulated, emulated, measured, computed
    bool operator==(const MeasuredDepth&) const = default;
};

}  // namespace ilf
