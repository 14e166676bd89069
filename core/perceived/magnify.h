// Puts a blurred block where the eye sees it: magnified about the optical centre and hidden by what is nearer.
#pragma once

#include "core/perceived/attention.h"
#include "core/perceived/disc_blur.h"

namespace ilf::view {

/// Where a block lies: its upper left corner in the window, and window pixels per block pixel.
struct Placement {
    double x = 0.0, y = 0.0;
    double pitch = 1.0;
};

/// into += weight * passing * colours of `block`; opacity += its last channel (if `opacity` is given). Cubic
/// (Catmull-Rom) resampling, 0 outside the block. `passing` may be empty. Radiance is conserved: magnified light is no
/// dimmer.
void addMagnified(Block& into, Block* opacity, const Block& passing, const Block& block, Placement placement,
                  const Appearance& look, bool sharp, int colours, float weight);

}  // namespace ilf::view
