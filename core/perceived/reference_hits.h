// Where a ray meets a surface, and what it meets there.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/perceived/reference_rays.h"
#include "core/perceived/reference_scene.h"

namespace ilf::reference {

/// What a ray meets on a surface: how much of it is stopped, and the light from there.
struct Met {
    double coverage = 0.0;
    std::array<double, 3> light{};
};

/// Bilinear between pixel centres, nothing outside the picture. `vergence` is asked by torn surfaces only.
Met met(const Frame& frame, const Surface& surface, const Light& light, Pair at, double vergence);

inline bool misses(const Surface& surface, Pair at) {
    return at.x < surface.x0 || at.y < surface.y0 || at.x > surface.x1 || at.y > surface.y1;
}

/// One ray through one point of the pupil at one moment, for surfaces whose distance is not known before it is met.
struct Path {
    const Optics& optics;
    Pair view;
    Pair aside;
    double surplus = 0.0, power = 0.0;

    /// Its view position at a vergence (1 / distance from the lens).
    Pair at(double vergence) const;
};

struct Meeting {
    double vergence = 0.0;
    Pair at;
};

/// Where a ray meets a plane: iterated on vergence until it stands still. None: it runs along it.
std::optional<Meeting> meetsPlane(const Surface& plane, const Path& path);

/// All points where a ray comes upon the surface of a depth map from before it, nearest first: followed from the
/// nearest vergence to the farthest in steps of half a pixel, each crossing refined. What lies behind the edge of a
/// nearer part is not met there.
void meetsMap(const Frame& frame, const Surface& map, const Path& path, std::vector<Meeting>& into);

}  // namespace ilf::reference
