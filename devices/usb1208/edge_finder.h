// Finds the projector's trigger edges in sampled volts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/quantity.h"

namespace ilf::devices {

/// For 3.3 V logic; a 1.8 V jumper needs lower ones. The gap is what noise may do without making edges.
struct EdgeLevels {
    Volt low = Volt::fromSi(0.8), high = Volt::fromSi(2.0);
    bool rising = true;
};

/// Goes over the samples once and keeps only the last one and the state, so blocks may be of any size.
///
/// An edge is where the straight line between two samples crosses the middle of the two levels. That is finer than a
/// sample only if the edge itself takes longer than one, as behind an RC filter of about 20 us; a bare logic edge is
/// known to half a sample.
class EdgeFinder {
public:
    explicit EdgeFinder(EdgeLevels levels = {}) : levels_(levels) {}

    /// Where edges are, in samples since the first one ever given.
    std::vector<double> found(std::span<const double> volts);

private:
    EdgeLevels levels_;
    bool armed_ = false;  ///< it has been on the side that edges come from
    double last_ = 0.0, crossing_ = 0.0;
    std::int64_t samples_ = 0;
};

}  // namespace ilf::devices
