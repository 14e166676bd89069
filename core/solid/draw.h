// Solids drawn by a camera: how far each pixel sees, and a picture of what it sees.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/registration/pinhole.h"
#include "core/solid/mesh.h"

namespace ilf {

struct DrawnSolid {
    Image<float> depth;  ///< metres along the camera's axis, of each pixel's centre; 0: nothing there
    /// RGB, sRGB-encoded. Light comes from the camera (a headlight): colour * (0.2 + 0.8 |cosine|) of the angle between
    /// surface and ray, without shadows or shine; black where nothing is.
    Image<std::uint8_t> colour;
};

/// Nearer things are cut off: 0.1 mm before the pinhole.
inline constexpr double kNearestDrawn_m = 1e-4;
/// Pixels along a side of what can be drawn.
inline constexpr int kLargestDrawn = 16384;

/// What `camera` sees. Both sides of every triangle stop light, since a scan's triangles may face anywhere. A pixel
/// shows the nearest triangle that covers its centre; triangles that share an edge leave no gap and overlap nowhere
/// (vertices lie on a grid of 1/4096 px; depth is the exact crossing of ray and triangle, in the nearness's 24 bits).
/// With lens distortion, what a pixel sees is looked up in an undistorted drawing of the same scale, so that outlines
/// are within half a pixel; depth is of the pixel's own ray. Pixels that the distortion model gives no ray for see
/// nothing. Deterministic. Preconditions: 1..kLargestDrawn pixels a side, fx and fy above 0, triangles' indices in
/// range.
DrawnSolid drawn(const Solid& solid, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& cameraFromModel);

/// Its depth alone, in less time.
Image<float> drawnDepth(const Solid& solid, const Pinhole& camera,
                        const Pose<CameraSpace, ModelSpace>& cameraFromModel);

}  // namespace ilf
