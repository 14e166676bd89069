// Where a camera stands in a solid's scene: from point pairs, or from the node of the scene that holds a camera.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/result.h"
#include "core/registration/pinhole.h"

namespace ilf {

/// A point of the scene and where the picture shows it.
struct PosePair {
    Point3<ModelSpace> model;
    Point<CameraFrame> picture;
    bool operator==(const PosePair&) const = default;
};

struct FoundPose {
    Pose<CameraSpace, ModelSpace> cameraFromModel;
    std::vector<double> residuals_px;  ///< of each pair
    double rms_px = 0.0;
    std::size_t worst = 0;  ///< the pair with the largest residual
    /// The second-best pose's rms where that fits nearly as well (within three times this one's, or 1 px more):
    /// four or more points of one plane seen from afar can be mirrored. A point off the plane decides.
    std::optional<double> rival_px;
};

/// The pose that brings the points closest to where the picture shows them (least squares of pixels; distortion of
/// `camera` counted). Refused: fewer than 4 pairs, points in a line, picture points in a line or all in one spot, and
/// pairs that no camera could see so (behind it, or off by more than a tenth of the picture's diagonal).
Result<FoundPose> poseFromPairs(std::span<const PosePair> pairs, const Pinhole& camera);

/// glTF's axes of a camera (x right, y up, looking along -z) to CameraSpace's (x right, y down, z forward): the one
/// place that knows both. `modelFromNode` is the node's matrix in the scene, column-major; scale and shear are taken
/// out. Nothing where it flattens space.
std::optional<Pose<CameraSpace, ModelSpace>> cameraFromGltfNode(const std::array<double, 16>& modelFromNode);

/// A camera at `eye` that sees `target` in its middle, the scene's y axis upwards in its picture (where it looks along
/// that axis, x is to the right). Precondition: eye and target differ.
Pose<CameraSpace, ModelSpace> lookingAt(const Point3<ModelSpace>& eye, const Point3<ModelSpace>& target);

}  // namespace ilf
