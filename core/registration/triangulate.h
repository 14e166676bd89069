// Depth of each camera pixel from where its light came from on the projector's raster.
#pragma once

#include "core/base/result.h"
#include "core/document/viewer_pose.h"
#include "core/registration/gray_code.h"

namespace ilf {

struct TriangulateOptions {
    double match_px = 0.25;        ///< one standard deviation of a decoded place on the raster, each of x and y
    double furthestMiss_px = 0.0;  ///< rays that pass each other farther than this are holes; 0: 4 standard deviations
    /// Share of depth by which all of it may be off together. Five poses leave 0.1 to 0.2 % (emulated scene).
    double common = 0.002;
    Metre nearest = 0.05_m, farthest = 50.0_m;  ///< of depth; anything else is a hole
};

/// Depth along the camera's axis, with what the check by both coordinates says.
struct Triangulated {
    MeasuredDepth depth;      ///< provenance as the calibration's
    Image<float> miss_px;     ///< signed distance of the decoded place from its epipolar line; NaN where not decoded
    double missRms_px = 0.0;  ///< over the measured pixels; about `match_px` when all is well
    int measured = 0, missed = 0;  ///< pixels with a depth, and decoded ones whose rays miss or leave the range
};

/// The depth at which the camera pixel's ray, seen from the projector, comes nearest to the decoded place (least
/// squares over x and y). `sigma` says how far it can be off by the noise of decoding and by the residuals of the
/// calibration, through the angle between the rays, and by what a calibration gets wrong for all pixels alike:
///
///     sigma_z^2 = (sigma_px / |d(x, y) / dz|)^2 + (common z)^2
///     sigma_px^2 = match^2 + (rms_projector^2 + (m rms_camera)^2) / 2
///
/// m: raster pixels that a pixel of the camera covers there.
/// Refused in words: other frame sizes than the calibration's, a baseline too short to measure depth, scans of whose
/// pixels hardly any ray meets its partner (another calibration).
Result<Triangulated> triangulated(const DecodedScan& decoded, const ProcamCalibration& calibration,
                                  const TriangulateOptions& options = {});
/// Of a dense map: guessed pixels stay holes.
Result<Triangulated> triangulated(const DenseMap& map, const ProcamCalibration& calibration,
                                  const TriangulateOptions& options = {});

}  // namespace ilf
