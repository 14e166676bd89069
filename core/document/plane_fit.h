// Planes for regions: fitted to the depth map, or laid through a printed marker.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/document/document.h"

namespace ilf {

struct FittedPlane {
    PlaneDistance distance;  ///< anchors on the region; tolerance: two standard deviations of what was fitted
    Metre rms;               ///< of the pixels it was fitted to, along the view
    double inliers = 1.0;    ///< share of the region's measured pixels that lie on it
};

/// The plane of a region's surface from the depth map beneath what is seen of it. Least squares of the vergence, which
/// is affine in the picture (see PlaneDistance), each pixel weighted by its own uncertainty where that is known, over
/// the pixels that agree with the best of 200 triples of them (within three robust standard deviations, 0.02 D at
/// least), so that hands and cups on a desk do not tilt it. The same map gives the same plane. Refused: no depth map,
/// fewer than 100 measured pixels, a region too thin to tell a slope, no plane that half of its pixels lie on, and a
/// plane that reaches infinity inside it.
Result<FittedPlane> fittedPlane(const Document& document, const Region& region);

/// A printed square marker lying on the surface.
struct SurfaceMarker {
    std::string dictionary = "APRILTAG_36h11";  ///< OpenCV's name without DICT_
    int id = 0;
    Metre side = 50.0_mm;  ///< of its black square, as measured on the print
    bool operator==(const SurfaceMarker&) const = default;
};

struct MarkerPlane {
    PlaneDistance distance;  ///< anchors where the region is, else on the marker's corners
    Metre markerDistance;    ///< of the marker's middle, from the wearer's lens
    double rms_px = 0.0;     ///< of its corners against the pose found
};

/// The plane a marker lies in, found in the scene's picture: pose from its four corners through `camera`, then to the
/// wearer. Its tolerance is what a tenth of a pixel, or the residual where that is more, on the marker's corners does
/// to its distance, twice: d * error / (side in pixels / sqrt 2), carried to the region's far end. Refused: an unknown
/// dictionary, a marker that is not in the picture or twice in it, one of less than 16 px a side, a surface seen
/// edge-on (more than 80 degrees), and one behind the lens.
Result<MarkerPlane> markerPlane(const Document& document, const Region& region, const Pinhole& camera,
                                const SurfaceMarker& marker);

/// The camera of the scene's picture as far as it is known: that of the measured depth, else the rig's calibration
/// where its size is the picture's, else a plain one from the pixel scale.
Pinhole sceneCamera(const Document& document);

}  // namespace ilf
