// A depth map as surfaces: where it bends, steps or is not known. What select_depth.cpp grows its masks on.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "core/base/image.h"
#include "core/document/distance.h"

namespace ilf::surfaces {

/// How far the places of a second difference are apart, and the side of the mean before it. The short one finds the
/// edges of small things, the long one the weak creases of far ones, which noise hides from the short.
struct Scale {
    int baseline, smooth;
    int band() const { return baseline + smooth / 2 + 1; }  // so far a step is felt
};
inline constexpr Scale kShort{6, 5}, kLong{14, 9};

/// The map in one of the two scales.
struct Scaled {
    cv::Mat1f smooth;   ///< kUnknown where too little was measured
    float bend = 0.0F;  ///< a second difference of more than this ends a surface
    cv::Mat1b within;   ///< 255: neither an edge nor unknown
};

struct Measured {
    cv::Mat1f vergence;  ///< 0 at holes
    cv::Mat1f own;       ///< what a pixel's own uncertainty allows, dioptres; empty: not known
    float noise = 0.0F;  ///< one standard deviation of a pixel against its neighbours, dioptres
};

struct Surfaces {
    Measured measured;
    Scaled near, far;
};

/// Rows shared between threads.
void forEachRow(int rows, const std::function<void(int)>& work);

Measured measuredOf(const DepthMap& depth);
/// Means over blocks of `side` x `side` pixels, of those that were measured.
Measured reduced(const Measured& full, int side);
/// `edges`: a picture of the same size whose strong edges end surfaces, too; or null.
Surfaces surfacesOf(Measured measured, const Picture* edges, double tolerance);
/// Whether there is a strong edge between two pixels.
bool differs(const Picture& picture, cv::Point a, cv::Point b);

}  // namespace ilf::surfaces
