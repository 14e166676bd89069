// A scan of the emulated scene beside what is true there.
#pragma once

#include <optional>

#include "app/scan/scan.h"

namespace ilf::app {

/// Distances on the raster between decoded pixels and the truth at their centres.
struct ScanAgainstTruth {
    int pixels = 0;       ///< decoded pixels that truly are lit, of every fourth row
    double rms_px = 0.0;  ///< of those within 2 px
    double beyond = 0.0;  ///< share of decoded pixels farther off, or not lit at all
};
/// None: the camera was another, whose truth nobody knows.
std::optional<ScanAgainstTruth> againstTruth(const ScanOrder& order, const ScanOutcome& outcome);

}  // namespace ilf::app
