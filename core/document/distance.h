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
    Metre tolerance = 0.0_m;  ///< the surface lies within it of the plane; of a fitted plane: two standard deviations
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

/// Depth of the whole picture, pixel by pixel: metres along the view axis from the wearer's lens; 0: a hole. Floats,
/// because sixteen bits cannot hold 0.1 m to 0.001 D and 2 m at once.
struct DepthMap {
    Image<float> metres;  ///< one channel, the picture's size
    Image<float> sigma;   ///< one standard deviation, metres; may be empty: not known
    Metre step = 0.0_m;   ///< one step of the whole numbers it was read from; 0: it was in metres
    bool operator==(const DepthMap&) const = default;
};

/// `raw` times `step`; raw 0 is a hole.
DepthMap depthOf(const Image<std::uint16_t>& raw, Metre step);
/// The whole numbers it came from; empty when some value is no whole multiple of the map's step, as after a change of
/// the viewer's pose.
Image<std::uint16_t> wholeSteps(const DepthMap& depth);

/// Vergence 1/d over the picture as an affine function: X(x, y) = at + dx * x + dy * y, in dioptres and dioptres per
/// camera pixel. Constant distances have dx = dy = 0.
struct AffineVergence {
    double at = 1.0, dx = 0.0, dy = 0.0;
    double operator()(double x, double y) const { return at + dx * x + dy * y; }
    bool operator==(const AffineVergence&) const = default;
};

}  // namespace ilf
