// The scene as rays meet it: surfaces, what they reflect, and the light of each level on them, in double.
#pragma once

#include <array>
#include <vector>

#include "core/perceived/exposures.h"
#include "core/perceived/perceived.h"

namespace ilf::reference {

/// View pixels; pixel (i, j) has its centre at (i + 0.5, j + 0.5). Row-major fields have one value for each.
struct Frame {
    Size size;
    double perPictureX = 1.0, perPictureY = 1.0;  ///< view pixels per picture pixel

    std::size_t count() const { return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
    }
    bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < size.width && y < size.height; }
};

/// One surface: regions at one distance, on one plane, or all that are read from the depth map.
struct Surface {
    enum class Kind { flat, plane, map };
    Kind kind = Kind::flat;
    AffineVergence vergence;               ///< flat and plane: over view positions
    std::vector<double> map;               ///< map: dioptres at each pixel, 0 where it has no surface
    double nearest = 0.0, farthest = 0.0;  ///< dioptres, of map
    double tear = 0.0;                     ///< map: neighbouring pixels that differ by more are not joined, dioptres
    std::vector<double> share;             ///< of each pixel, after the regions above took theirs
    /// What it covers of what nearer surfaces leave of a pixel (nearer there), so that an unblurred view is the
    /// picture.
    std::vector<double> alpha;
    double x0 = 0.0, y0 = 0.0, x1 = -1.0, y1 = -1.0;  ///< half a pixel around all it covers

    /// At a pixel's centre, dioptres; 0: none there.
    double at(const Frame& frame, int x, int y) const;
};

/// Light of one level (or the room's).
struct Light {
    std::vector<double> radiance;  ///< light times reflectance, 3 for each pixel
    std::vector<view::Exposure> exposures;
    double weight = 0.0;  ///< of all exposures
};

struct Scene {
    Frame frame;
    std::vector<Surface> surfaces;  ///< flat ones nearest first, then the others
    std::vector<Light> lights;      ///< dark ones left out
    std::vector<double> plain;      ///< the plain view, 3 for each pixel
};

/// Precondition: the document has a picture, the program's first images are the plan's levels.
Scene scene(const Document& document, const Plan& plan, const Program& program, double scale);

}  // namespace ilf::reference
