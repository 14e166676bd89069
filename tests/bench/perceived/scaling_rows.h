// How the time of a full frame grows: with slots, radius, regions and pixels.
#pragma once

#include "tests/bench/perceived/calibration.h"

namespace ilf::bench {

/// One thread, so that nothing else on the machine changes a ratio. False, with a sentence on stderr, if a scene cannot
/// be made.
bool addScalingRows(Table& table, const Patience& patience);

}  // namespace ilf::bench
