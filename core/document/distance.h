// How far a surface is from the wearer's lens: constant, a plane, or read from the scene's depth map.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "core/base/geometry.h"
#include "core/base/image.h"
#include "core/base/quantity.h"

namespace ilf {

/// Distances run from the wearer's lens, along the view axis (d_oE of the paper), in metres.
struct ConstantDistance {
    Metre value = 1.0_m;
    Metre tolerance;  ///< the surface lies within value +- tolerance
    bool operator==(const ConstantDistance&) const = default;
};

/// One point of the picture whose distance is known.
struct DistanceAnchor {
    Point<CameraFrame> at;
    Metre distance = 1.0_m;
    bool operator==(const DistanceAnchor&) const = default;
};

/// The plane through three anchors. In the picture of a pinhole camera the vergence of a plane, counted from the
/// pinhole, is affine in x and y. Here vergence is counted from the wearer's lens, d_Ee = 20 mm before it, and taken as
/// affine between the anchors: within 0.01 D for anchors at 0.4 m and beyond, a seventh of the narrowest focus border.
struct PlaneDistance {
    std::array<DistanceAnchor, 3> anchors;
    bool operator==(const PlaneDistance&) const = default;
};

/// Read per pixel from the scene's depth map.
struct FromDepthMap {
    Metre tolerance;
    bool operator==(const FromDepthMap&) const = default;
};

/// The farthest distance that can be typed, and where a plane ends that would reach infinity: 0.001 D.
inline constexpr Metre kFarthestDistance = 1000.0_m;

using Distance = std::variant<ConstantDistance, PlaneDistance, FromDepthMap>;

/// Depth of the whole picture: `raw` has one channel and the picture's size; distance = raw * metresPerUnit; raw 0 is
/// a hole. Distances are axial, from the wearer's lens.
struct DepthMap {
    Image<std::uint16_t> raw;
    Metre metresPerUnit = 1.0_mm;
    Image<std::uint16_t> sigma;  ///< one standard deviation in the same units; may be empty: not known
    bool operator==(const DepthMap&) const = default;
};

/// Vergence 1/d over the picture as an affine function: X(x, y) = at + dx * x + dy * y, in dioptres and dioptres per
/// camera pixel. Constant distances have dx = dy = 0.
struct AffineVergence {
    double at = 1.0, dx = 0.0, dy = 0.0;
    double operator()(double x, double y) const { return at + dx * x + dy * y; }
    bool operator==(const AffineVergence&) const = default;
};

}  // namespace ilf
