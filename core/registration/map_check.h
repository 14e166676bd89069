// Whether a map holds: stripes are shown anew, and where the camera sees their edges the map must say so.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/registration/gray_code.h"
#include "core/registration/pixel_map.h"

namespace ilf {

/// A column or row pattern with stripes some 16 raster pixels wide, to be shown with its inverse.
Pattern checkPattern(Pattern::Kind kind, Size projector);

/// Residuals are distances on the raster, across the stripes, between an edge as it was shown and the map of where the
/// camera sees it (sub-pixel, where picture and inverse are equal between two neighbouring pixels).
struct MapCheck {
    int edges = 0;          ///< edge points found where the map was decoded
    double rms_px = 0.0;    ///< of those within 4 px
    double worst_px = 0.0;  ///< of the same, the largest
    double beyond = 0.0;    ///< share of edge points farther off than 4 px
    bool holds() const { return edges >= 50 && rms_px <= 1.0 && beyond <= 0.1; }
};

/// Refused when sizes differ, or the pattern is neither columns nor rows.
Result<MapCheck> mapCheck(const DenseMap& map, const Pattern& shown, const Image<std::uint8_t>& picture,
                          const Image<std::uint8_t>& inverse);

}  // namespace ilf
