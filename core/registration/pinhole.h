// A camera or projector as a pinhole with lens distortion, and what a calibration of the pair knows.
#pragma once

#include <array>
#include <string>

#include "core/base/geometry.h"
#include "core/registration/space.h"

namespace ilf {

/// Intrinsics in pixels of the frame they belong to, where pixel (i, j) has its centre at (i + 0.5, j + 0.5): cx and cy
/// are OpenCV's plus 0.5. A projector is a camera whose light goes the other way.
struct Pinhole {
    Size size;
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
    std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3 of OpenCV's (Brown's) model
    bool operator==(const Pinhole&) const = default;

    /// Where the ray with slopes (x / z, y / z) meets the raster.
    std::array<double, 2> pixelOf(double slopeX, double slopeY) const;
    /// The slopes of the ray through a pixel: distortion is undone by iteration, to 1e-12 where it can be undone.
    std::array<double, 2> slopesOf(double x, double y) const;
};

/// A camera without distortion that spans `focalPixels`, its axis through the middle.
Pinhole plainPinhole(Size size, double focalPixels);

/// Camera and projector, and how they stand to each other. Residuals are rms reprojection errors in pixels.
struct ProcamCalibration {
    Pinhole camera, projector;
    Pose<ProjectorSpace, CameraSpace> projectorFromCamera;
    double cameraRms_px = 0.0, projectorRms_px = 0.0;
    int poses = 0;           ///< of the board
    std::string scale;       ///< where metres come from: "board" or "tape"
    std::string taken;       ///< UTC, ISO 8601
    std::string provenance;  ///< simulated, emulated, measured
    bool operator==(const ProcamCalibration&) const = default;
};

}  // namespace ilf
