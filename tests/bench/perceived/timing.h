// Times a call again and again, and says what else ran on the machine meanwhile.
#pragma once

#include <chrono>
#include <functional>

#include "tests/bench/perceived/row.h"

namespace ilf::bench {

/// How long one row may take. Thirty repetitions or more, unless they would take longer than `seconds`; never fewer
/// than `least`.
struct Patience {
    double seconds = 0.35;
    int enough = 30, least = 3, most = 300;
};

/// Times `work(i)` for i = 0, 1, 2 ...; `prepare(i)` runs before each, untimed. The first call warms caches and is not
/// counted.
Times timed(const Patience& patience, const std::function<void(int)>& work,
            const std::function<void(int)>& prepare = {});

/// What ran on all processors and what this program ran, in seconds since some start.
struct Load {
    double all = 0.0, own = 0.0;
    std::chrono::steady_clock::time_point at;
    static Load now();
};

/// Processes ready to run over the last minute.
double loadAverage();

}  // namespace ilf::bench
