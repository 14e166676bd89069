// What the machine could do at best, so that a time reads as a share of it.
#pragma once

#include <string>

#include "tests/bench/perceived/row.h"
#include "tests/bench/perceived/timing.h"

namespace ilf::bench {

/// Fused multiply-adds count as two operations.
struct Machine {
    double gflops = 0.0;                ///< one thread, the widest registers it has
    double triad1 = 0.0, triad2 = 0.0;  ///< GB/s of a[i] = b[i] + s c[i] beyond the caches, one and two threads
    double cached2 = 0.0;               ///< the same on 9 MB, about what a frame touches, two threads
    double bandwidth(int threads) const { return threads == 1 ? triad1 : triad2; }
};

/// Measures it, and adds the rows.
Machine calibrated(Table& table);

}  // namespace ilf::bench
