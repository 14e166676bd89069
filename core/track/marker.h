// Printed markers (ArUco and AprilTag) in a picture: where their corners are, and how sure that is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/track/quad.h"

namespace ilf {

struct MarkerSearch {
    std::string dictionary = "APRILTAG_36h11";  ///< OpenCV's name without DICT_
    std::vector<int> ids;                       ///< only these are told apart from anything else
    PixelRect<CameraFrame> window;              ///< looked at; empty: the whole picture
    int coarse = 1;  ///< candidates are looked for in a picture so many times smaller; corners come from the whole one
    int around = 0;  ///< side of the square that says what is dark, pixels; 0: 5, 13 and 21, each as long as one alone
};

/// What one picture can afford of a search of all of it: every other look takes half the size, which shows markers from
/// some 40 px, and the others strips at full size in turn, down to 12 px, each with 5 or 21 px around. A picture of
/// 1280 x 720 pixels is through after twelve looks, `look` = 0, 1, ...
MarkerSearch partOfSearch(MarkerSearch whole, Size picture, int look);

struct SeenMarker {
    int id = 0;
    Quad corners;             ///< of the black square's outer edge
    double confidence = 0.0;  ///< 0..1: how much of its outline is a clear straight edge
    double rms_px = 0.0;      ///< of the outline's edge points about four straight lines
};

/// All markers of these ids, each as often as it is there. Candidates and bits are OpenCV's (aruco of 4.6, contours);
/// the corners are not: the outline's edges are found to a fraction of a pixel along each side, a line is fitted
/// through each (Huber), and the lines are intersected, as AprilTag does (E. Olson, "AprilTag: A robust and flexible
/// visual fiducial system", ICRA 2011; `refine_edges`), which is what is left where cornerSubPix would slip to a corner
/// of the pattern inside. `grey`: one channel. Refused: an unknown dictionary, or an id that it does not have.
Result<std::vector<SeenMarker>> findMarkers(const Image<std::uint8_t>& grey, const MarkerSearch& search);

/// Whether there is such a marker, or why not.
Result<void> checkedMarker(const std::string& dictionary, int id);

}  // namespace ilf
