// A registration: where the camera's picture lands on the projector, how it was found and how far to trust it.
#pragma once

#include <string>

#include "core/registration/pixel_map.h"

namespace ilf {

/// How a camera's picture was cut out of its sensor. A registration belongs to one mode.
struct CameraMode {
    std::string device;  ///< the camera's stable id; empty: not known
    Size sensor;         ///< whole, in unbinned pixels; 0 x 0: not known
    int x0 = 0, y0 = 0;  ///< corner of the part read out, unbinned pixels
    int binning = 1;     ///< sensor pixels along a side of one pixel of the picture
    Size picture;        ///< 0 x 0: any
    bool operator==(const CameraMode&) const = default;
};

struct Registration {
    enum class Method { typed, corners, pointPairs, chessboard, scan };
    PixelMap map;
    CameraMode camera;
    Size projector;  ///< the raster it was made on; 0 x 0: not known
    Method method = Method::typed;
    double rms_px = 0.0, worst_px = 0.0;  ///< residuals of what it rests on, on the raster, projector pixels: root of
                                          ///< the mean square and largest; of a scan those of stripes shown anew
    int points = 0;                       ///< pairs or decoded pixels it rests on
    std::string taken;                    ///< UTC, ISO 8601; empty: not known
    std::string projectorName;            ///< the projector's identity; empty: not known
    std::string provenance;               ///< typed, simulated, emulated or measured
    bool operator==(const Registration&) const = default;
};

/// A homography typed or made up: no residuals, any camera.
Box<Registration> registered(const Homography<ProjectorFrame, CameraFrame>& projectorFromCamera);

}  // namespace ilf
