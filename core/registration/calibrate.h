// Camera and projector as pinholes, and how they stand to each other, from several poses of a chessboard.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/registration/board.h"
#include "core/registration/pinhole.h"

namespace ilf {

/// One standard deviation of each of a pinhole's numbers, pixels where those are pixels; 0: held, not estimated.
struct PinholeDeviation {
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
    std::array<double, 5> distortion{};
    bool operator==(const PinholeDeviation&) const = default;
};

/// How well one pose of the board fits.
struct PoseFit {
    std::string name;
    bool used = true;                            ///< not: it fits so badly that it was left out
    double camera_px = 0.0, projector_px = 0.0;  ///< rms reprojection errors
    int cameraCorners = 0, projectorCorners = 0;
    Pose<CameraSpace, ModelSpace> cameraFromBoard;
    bool operator==(const PoseFit&) const = default;
};

struct Calibrated {
    ProcamCalibration calibration;  ///< `taken` and `provenance` are the caller's to say
    PinholeDeviation camera, projector;
    std::array<double, 3> translation_m{};  ///< one standard deviation of each of the pose's numbers
    std::array<double, 3> rotation_rad{};
    std::vector<PoseFit> poses;      ///< in the views' order
    double widestTilt_deg = 0.0;     ///< the largest angle between two poses' normals
    std::vector<std::string> notes;  ///< for the operator: what was left out, held or is uncertain
    bool operator==(const Calibrated&) const = default;
};

/// All corners of all views, seen by both, explained by one set of numbers with the least squared pixel error, each
/// device's weighed by its own noise (bundle adjustment from OpenCV's calibrateCamera and a direct solution for the
/// projector, whose principal point may lie far outside its raster). Few poses, few terms of distortion: k1 below four
/// poses, k2 from four, p1 and p2 from five, k3 from eight; and of these only terms that explain more than noise
/// (Bayesian information criterion). A pose that fits three times worse than the others is named and left out.
/// Refused in words: fewer than two poses, poses that are nearly parallel, a focal length that stays uncertain by more
/// than 3 %, fits that do not come below 5 px, views of different frames.
Result<Calibrated> calibrated(std::span<const BoardView> views, const Board& board);

struct CalibratedCamera {
    Pinhole camera;
    PinholeDeviation deviation;
    double rms_px = 0.0;
    std::vector<PoseFit> poses;
    double widestTilt_deg = 0.0;
    std::vector<std::string> notes;
    bool operator==(const CalibratedCamera&) const = default;
};

/// The same for the camera alone: `onProjector` is not looked at.
Result<CalibratedCamera> calibratedCamera(std::span<const BoardView> views, const Board& board);

/// The calibration with another scale: what it gives as `calibrated` metres is in truth `measured`. Angles and pixels
/// stay as they are.
Result<ProcamCalibration> rescaled(ProcamCalibration calibration, Metre calibrated, Metre measured);

/// Whether the numbers can be a calibration's: sizes and focal lengths above 0, finite, a rotation that is one.
Result<void> checked(const ProcamCalibration& calibration);

}  // namespace ilf
