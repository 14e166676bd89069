// Waits until something is so, by looking.
#pragma once

#include <chrono>
#include <thread>

namespace ilf::app {

/// False if it is not so within `time`.
template <class Condition>
bool within(std::chrono::milliseconds time, Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + time;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

}  // namespace ilf::app
