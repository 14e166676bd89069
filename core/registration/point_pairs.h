// Registrations without a scan: four corners, pairs of points, and a projected chessboard.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/registration/board.h"
#include "core/registration/registration.h"

namespace ilf {

/// The same spot in the camera's picture and on the projector's raster.
struct PointPair {
    Point<CameraFrame> camera;
    Point<ProjectorFrame> projector;
    bool operator==(const PointPair&) const = default;
};

/// A registration with what each of its pairs says of it.
struct PairedRegistration {
    Registration registration;        ///< `taken`, `camera.device` and `provenance` are the caller's to say
    std::vector<double> residual_px;  ///< of each pair, on the raster
    std::vector<bool> used;           ///< not: so far off that it was left out
    int worst = -1;                   ///< the pair that fits worst
    std::string note;                 ///< one sentence for the operator; empty: nothing to say
};

/// From where the raster's corners are seen: upper left, upper right, lower right, lower left, as the projector has
/// them. Refused in words: corners on one line, crossed, folded in, mirrored.
Result<PairedRegistration> registeredByCorners(const std::array<Point<CameraFrame>, 4>& corners, Size camera,
                                               Size projector);

/// From at least four pairs; from six on, pairs that do not fit the others are left out and named. Refused in words:
/// too few pairs, pairs on one line, a mirrored picture, pairs that do not fit each other.
Result<PairedRegistration> registeredByPairs(std::span<const PointPair> pairs, Size camera, Size projector);

/// The chessboard a projector shows so that a camera can be registered by it: 10 x 7 squares, so that turning it by
/// half a turn exchanges black and white.
struct ProjectedBoard {
    Board board;                                 ///< corners of the picture
    std::vector<Point<ProjectorFrame>> corners;  ///< row by row
};
ProjectedBoard projectedBoard(Size projector);
/// What the projector shows: 0 or 255; `inverse` with black and white exchanged.
Image<std::uint8_t> projectedBoardPicture(Size projector, bool inverse);

/// From pictures of the projected board and of its inverse: what lies in the scene cancels in their difference.
Result<PairedRegistration> registeredByBoard(const Image<std::uint8_t>& seen, const Image<std::uint8_t>& seenInverse,
                                             Size projector);

}  // namespace ilf
