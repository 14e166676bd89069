// Holes in a field of numbers are continued smoothly from what lies around them.
#pragma once

#include <vector>

#include "core/base/geometry.h"

namespace ilf {

/// A picture of pairs of numbers; `known` (same length / 2) is 1 where they are known and 0 in holes.
struct Field {
    Size size;
    std::vector<float> values;
    std::vector<float> known;
};

/// Fills the holes by push-pull (Gortler et al., "The Lumigraph", SIGGRAPH 1996): means of ever larger neighbourhoods
/// of known numbers, interpolated back down, so that each hole takes the finest mean that knows something there. Known
/// numbers stay as they are; where nothing is known at all, zeros.
void fillHoles(Field& field);

}  // namespace ilf
