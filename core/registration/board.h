// A printed chessboard: its corners in a picture, and where a scan puts them on the projector's raster.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/registration/gray_code.h"
#include "core/registration/space.h"

namespace ilf {

/// Corners are the inner ones, where black squares meet.
struct Board {
    int columns = 9, rows = 6;
    Metre square = 25.0_mm;  ///< side of one square, as measured on the print
    bool operator==(const Board&) const = default;
};

/// The board's corners, row by row, in its own plane: x along a row, y from row to row, z = 0.
std::vector<Point3<ModelSpace>> cornersOf(const Board& board);

/// Refused in words: fewer than 3 x 3 corners, a square without a size, more than 10000 corners.
Result<void> checked(const Board& board);

/// The board's corners in a grey picture under white light, to about 0.05 px, row by row and the same way round as on
/// the print (never mirrored; which of its ends comes first is not told by a chessboard). `name`: of the picture, for
/// the refusal.
Result<std::vector<Point<CameraFrame>>> boardCorners(const Image<std::uint8_t>& grey, const Board& board,
                                                     const std::string& name);

/// The board in one pose, as the camera sees it and as the projector would.
struct BoardView {
    std::string name;  ///< of the pose, for the operator
    Size camera, projector;
    std::vector<Point<CameraFrame>> inCamera;                       ///< row by row
    std::vector<std::optional<Point<ProjectorFrame>>> onProjector;  ///< none: too little was decoded around it
    double decoded_px = 0.0;  ///< rms of decoded pixels around corners against what was fitted to them, on the raster
    bool operator==(const BoardView&) const = default;
};

/// Where the camera's corners lie on the raster: around each, a homography is fitted to the decoded pixels, robustly,
/// so that holes, edges and wrong codes do not matter, and the corner is sent through it.
/// Source: Moreno and Taubin, "Simple, accurate, and robust projector-camera calibration", 3DIMPVT 2012, section 4.
/// Refused when fewer than half of the corners find enough decoded pixels around them.
Result<BoardView> boardView(std::vector<Point<CameraFrame>> corners, const DecodedScan& decoded, const Board& board,
                            const std::string& name);
/// Both at once: `white` is the scan's picture under white light.
Result<BoardView> boardView(const Image<std::uint8_t>& white, const DecodedScan& decoded, const Board& board,
                            const std::string& name);

}  // namespace ilf
