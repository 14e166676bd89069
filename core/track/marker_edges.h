// The outline of a marker to a fraction of a pixel.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/track/quad.h"

namespace ilf {

struct Outlined {
    Quad corners;
    double found = 0.0;     ///< share of the places along the outline where there is a clear edge
    double rms_px = 0.0;    ///< of these edges about the fitted lines
    double contrast = 0.0;  ///< mean step across the outline, grey values
};

/// Corners of a dark quad on a lighter ground, from `rough` ones (within a module of the truth). `modules`: cells along
/// a side with its border, 8 for AprilTag 36h11: the search goes no farther than most of one, where the pattern begins.
Outlined outlined(const Image<std::uint8_t>& grey, const Quad& rough, int modules);

}  // namespace ilf
