// One plane of 1024 x 768 blurred by a disc: every way of doing it, beside the exact disc.
#pragma once

#include "tests/bench/perceived/calibration.h"

namespace ilf::bench {

/// Adds a row for each method and radius (one thread; the text picture's error, the natural one's in the note).
void addPlaneRows(Table& table, const Machine& machine, const Patience& patience);

}  // namespace ilf::bench
