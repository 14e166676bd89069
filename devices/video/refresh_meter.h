// How often a display is really sent a picture, from the times at which swaps were done.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/base/quantity.h"

namespace ilf::devices {

/// Fits a straight line through the times of swaps over their frame numbers. Pure: time is an argument.
///
/// Says 0 until the line's slope is known to 150 ppm (standard error; 59.94 is 1000 ppm from 60), and for good once the
/// swaps turn out not to wait for the display: where the server names no rate, or the first swaps, which are to follow
/// each other directly, are not that far apart.
class RefreshMeter {
public:
    /// `nominal`: by the mode's timing, 0 where the server does not say.
    explicit RefreshMeter(Hertz nominal) : nominal_(nominal) {}

    /// A swap was done at `at`; `count` is the server's own number of that frame, where it has one.
    void saw(std::chrono::nanoseconds at, std::optional<std::int64_t> count);
    Hertz rate() const { return rate_; }
    bool waits() const { return nominal_ > 0.0_Hz; }

    /// So many swaps, one directly after the other, give a rate even where time stamps jitter by 0.2 ms.
    static constexpr int kFirstSwaps = 40;

private:
    struct Sample {
        double at_s;
        double frame;
    };
    void fit();

    Hertz nominal_;
    Hertz rate_;
    std::deque<Sample> samples_;
    std::optional<std::int64_t> lastCount_;
    int seen_ = 0, together_ = 0;  ///< of the first swaps: intervals, and those that are one frame long
};

}  // namespace ilf::devices
