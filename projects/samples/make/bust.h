// A half-figure carved from smooth-joined solids: a draped woman who holds a small vessel in both hands.
#pragma once

#include "vec.h"

namespace ilf::samples::bust {

// Metres in the statue's own frame: y up from the underside, z to the front, x to the viewer's right.
float head(V3 p);
float body(V3 p);
float hands(V3 p);
float vessel(V3 p);

inline constexpr V3 kVesselCentre{0.0f, 0.155f, 0.175f};

}  // namespace ilf::samples::bust
