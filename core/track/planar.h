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

/// Near where it is thought to be: the pattern is drawn as it should look there, optical flow (pyramidal Lucas-Kanade)
/// tells how far each point is off, and a robust homography is fitted to what they say. Since the pattern itself is
/// compared, never the frame before, errors do not add up. Follows up to some 20 px of error in `near`.
std::optional<SeenPlanar> followPlanar(const PlanarPattern& pattern, const Image<std::uint8_t>& grey,
                                       const Motion& near);

/// A search anywhere in a picture, shared out over the pictures that come, since all of it takes longer than one may.
/// The first picture is kept, small: three looks find its ORB features, from the finest on, and what they resemble
/// most in the pattern, then a robust homography; the fourth follows in the newest picture from there.
struct PlanarSearch {
    static constexpr int kLooks = 4;
    int look = 0;              ///< the next one
    Image<std::uint8_t> kept;  ///< of the first look
    double scale = 1.0;        ///< its pixels over the picture's
    struct Nearest {
        double best = 1e9, second = 1e9;  ///< bits that differ
        Point<CameraFrame> at;            ///< of the best, in the picture
    };
    std::vector<Nearest> nearest;  ///< of each of the pattern's features
    Motion rough;                  ///< before the last look
};

/// One look of such a search, which begins anew after the last one and when nothing is there. A target that is in
/// sight, and moves less than some 20 px from the first look to the last, is seen by the last one.
std::optional<SeenPlanar> lookedFor(PlanarSearch& search, const PlanarPattern& pattern,
                                    const Image<std::uint8_t>& grey);

}  // namespace ilf
