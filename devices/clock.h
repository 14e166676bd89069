// The time a driver waits by: the machine's, or a test's that jumps.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

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

}  // namespace ilf::devices
