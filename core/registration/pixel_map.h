// Where a camera's picture lands on the projector's raster: one homography, or a dense map that was scanned.
#pragma once

#include <cstdint>
#include <variant>

#include "core/base/box.h"
#include "core/base/geometry.h"
#include "core/base/image.h"

namespace ilf {

/// A scanned map. Both directions are finite everywhere: where nothing was decoded, values continue what lies around,
/// and `confidence` and `seen` tell such guesses apart. Points are in the frames' own pixels (centres at + 0.5).
struct DenseMap {
    Image<float> projectorOfCamera;  ///< camera's size; x, y on the raster of each camera pixel's centre
    Image<std::uint8_t> confidence;  ///< camera's size; 0: a guess; 1 to 255: how sure a decoded pixel is
    Image<float> cameraOfProjector;  ///< raster's size; x, y in the picture of each projector pixel's centre
    Image<std::uint8_t> seen;        ///< raster's size; 255 where the camera sees the pixel's light, 0 where not
    Homography<ProjectorFrame, CameraFrame> nearest;  ///< what fits all decoded pixels best: continues the map outside
    bool operator==(const DenseMap&) const = default;

    Size camera() const { return projectorOfCamera.size(); }
    Size projector() const { return cameraOfProjector.size(); }
};

/// A value; copies share what is inside. Default: the identity.
class PixelMap {
public:
    PixelMap() = default;
    explicit PixelMap(const Homography<ProjectorFrame, CameraFrame>& plane);
    /// Precondition: the map is not empty and its four pictures have the sizes their lines say.
    explicit PixelMap(Box<DenseMap> dense);

    /// The homography, or nullptr: what can be done exactly and fast for a plane.
    const Homography<ProjectorFrame, CameraFrame>* plane() const;
    /// The dense map, or an empty box.
    const Box<DenseMap>& dense() const { return dense_; }
    /// The homography, or the one that fits the dense map best.
    const Homography<ProjectorFrame, CameraFrame>& nearest() const { return plane_; }

    /// Bilinear between the dense map's pixels; beyond its picture the best homography, shifted to meet it at the edge.
    Point<ProjectorFrame> toProjector(Point<CameraFrame> at) const;
    Point<CameraFrame> toCamera(Point<ProjectorFrame> at) const;
    /// Whether light of this projector pixel falls where the camera sees it. For a homography: always.
    bool seen(int x, int y) const;

    bool operator==(const PixelMap&) const = default;

private:
    Homography<ProjectorFrame, CameraFrame> plane_;
    Homography<CameraFrame, ProjectorFrame> back_;
    Box<DenseMap> dense_;
};

}  // namespace ilf
