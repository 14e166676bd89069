// Inside the diagnosis: what pictures of a scan tell about light, motion, old frames and gloss.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/registration/gray_code.h"

namespace ilf {

/// Numbers of the pictures of a pattern and of its inverse; half a stripe is 2^level raster pixels.
struct PatternPair {
    int picture, inverse, level;
};
/// In the order they were taken.
std::vector<PatternPair> patternPairs(const Scan& scan);

/// Lit: white at least 5 of 255 above black, and below the sensor's end.
struct ScanLight {
    int lit = 0, saturated = 0;   ///< pixels; saturated: white at the end of the range
    double blackSaturated = 0.0;  ///< share of pixels where even black is
    double contrast = 0.0;        ///< white above black, median of the lit
    double projectorShare = 0.0;  ///< (white - black) / white, median of the lit
    double following = 0.0;       ///< most of the picture that changes between a pattern and its inverse, not all alike
    int brightest = 0;            ///< level that 1 % of all pixels of the white picture reach
};
/// Precondition of all here: decodedScan(scan) did not refuse the scan.
ScanLight scanLight(const Scan& scan);

/// Numbers of the pictures of a pattern and its inverse that hardly differ, though stripes are wide.
std::vector<std::pair<int, int>> staleFrames(const Scan& scan);

/// A pattern and its inverse together are white and black together, as long as nothing moves.
struct Motion {
    double shift_px = 0.0;        ///< of the whole picture, camera pixels; 0 where only a part moved
    int picture = 0;              ///< first one that is off
    PixelRect<CameraFrame> area;  ///< of the part that moved; empty: all
};
std::optional<Motion> motionIn(const Scan& scan);

/// Well lit pixels (contrast of 20 or more) whose patterns are unclear though their neighbours' are not an edge's.
struct Mixed {
    double share = 0.0;
    PixelRect<CameraFrame> area;
};
Mixed mixedLight(const Scan& scan, const DecodedScan& decoded);

/// The smallest rectangle that holds nine tenths of a state's pixels each way.
PixelRect<CameraFrame> areaOf(const DecodedScan& decoded, PixelState state);

/// Whether nearly all decoded pixels lie within 1 px of one homography.
bool isFlat(const DecodedScan& decoded);

}  // namespace ilf
