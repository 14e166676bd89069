// The emulated scene's camera and projector: a pinhole whose lens bends straight lines.
#pragma once

#include <array>
#include <optional>

#include "core/base/geometry.h"
#include "devices/emulated_scene/vec3.h"

namespace ilf::devices::scene {

/// A raster behind (or, of a projector, before) a lens. Raster coordinates: pixel (i, j) covers [i, i + 1) x [j, j +
/// 1). Distortion after Brown (1966), in the order in which calibrations give it: k1, k2, p1, p2, k3, on slopes x / z
/// and y / z before the focal length.
struct SceneLens {
    Size size{1280, 1024};
    double focalX = 0.0, focalY = 0.0;    ///< pixels
    double centreX = 0.0, centreY = 0.0;  ///< raster coordinates of the axis
    std::array<double, 5> bend{};
    bool operator==(const SceneLens&) const = default;

    /// Where a point before the lens (z > 0 along the axis) lands on the raster's plane; none behind it.
    std::optional<std::array<double, 2>> rasterOf(const Vec3& inDevice) const;
    /// The direction (z = 1) of the ray through a place of the raster.
    Vec3 rayThrough(double x, double y) const;
};

/// The same lens read out in part and with pixels put together: `corner` in unbinned pixels.
SceneLens readOut(const SceneLens& whole, int cornerX, int cornerY, Size unbinned, int binning);

}  // namespace ilf::devices::scene
