// `calibrate`: camera and projector as pinholes, from scans of a chessboard in several poses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::app {

struct CalibrateOptions {
    std::vector<std::string> folders;  ///< one scan each, in decode-scan's order, the board in another pose in each
    std::string board = "9x6";         ///< inner corners
    std::string square = "25mm";       ///< side of a square
    std::string projector;             ///< "1024x768"; empty: as the scans say
    std::string opencv;                ///< instead of folders: a calibration_result.xml of procam-calibration
    std::string out;                   ///< file to write
    bool json = false;
};

/// Prints residuals of each pose and how certain the numbers are; refuses one pose, or nearly parallel ones, with the
/// reason. Nothing is written where it refuses.
int calibrateCommand(const CalibrateOptions& options);

/// "1024x768".
std::optional<Size> sizeFromWords(const std::string& text);
/// "75mm", "2.5 cm", "0.075 m"; a bare number is refused: nobody would know its unit.
Result<Metre> lengthFromWords(const std::string& text);

}  // namespace ilf::app
