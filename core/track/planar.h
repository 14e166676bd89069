// A flat thing with a texture of its own: how it looked, and where it is now.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/box.h"
#include "core/base/image.h"
#include "core/base/result.h"
#include "core/track/quad.h"

namespace ilf {

/// How the thing looked where the region was painted.
struct PlanarPattern {
    PixelRect<CameraFrame> patch;
    Image<std::uint8_t> grey;                  ///< the patch alone, one channel
    std::vector<Point<CameraFrame>> points;    ///< where its texture shows motion both ways, in the picture
    double spread = 0.0;                       ///< area of the points' hull, px^2
    std::vector<Point<CameraFrame>> features;  ///< told again anywhere by `descriptors`, in the picture
    Image<std::uint8_t> descriptors;           ///< ORB, a row each
    bool operator==(const PlanarPattern&) const = default;
};

/// Refused, in words: a patch outside the picture, or with too little texture to be told by.
Result<Box<PlanarPattern>> planarPattern(const Image<std::uint8_t>& grey, const PixelRect<CameraFrame>& patch);

struct SeenPlanar {
    Motion motion;            ///< from where it was in the pattern's picture
    double confidence = 0.0;  ///< 0..1, from how many of its points agree, how far they spread and how alike they look
    int inliers = 0, asked = 0;
    double rms_px = 0.0;  ///< of the inliers
};

/// Anywhere in the picture, by ORB features and a robust homography, then as `followPlanar` from there. Some 10 ms.
std::optional<SeenPlanar> findPlanar(const PlanarPattern& pattern, const Image<std::uint8_t>& grey);

/// Near where it is thought to be: the pattern is drawn as it should look there, optical flow (pyramidal Lucas-Kanade)
/// tells how far each point is off, and a robust homography is fitted to what they say. Since the pattern itself is
/// compared, never the frame before, errors do not add up. Follows up to some 20 px of error in `near`.
std::optional<SeenPlanar> followPlanar(const PlanarPattern& pattern, const Image<std::uint8_t>& grey,
                                       const Motion& near);

}  // namespace ilf
