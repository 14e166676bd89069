// The time a driver waits by: the machine's, or a test's that jumps.
#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "core/base/quantity.h"

namespace ilf::devices {

/// `now` never goes backwards; `wait` returns once `now` has advanced by that much.
struct Clock {
    std::function<std::chrono::nanoseconds()> now;
    std::function<void(std::chrono::nanoseconds)> wait;

    static Clock steady() {
        return {[] { return std::chrono::steady_clock::now().time_since_epoch(); },
                [](std::chrono::nanoseconds time) { std::this_thread::sleep_for(time); }};
    }
};

/// To the nearest nanosecond.
inline std::chrono::nanoseconds inNs(Second time) { return std::chrono::nanoseconds(std::llround(time.si() * 1e9)); }

}  // namespace ilf::devices
