// Time gone by, as it is shown.
#pragma once

#include <chrono>

namespace ilf {

inline double millisecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace ilf
