#include "devices/usb1208/edge_finder.h"

namespace ilf::devices {

std::vector<double> EdgeFinder::found(std::span<const double> volts) {
    // Falling edges are rising ones upside down.
    const double sign = levels_.rising ? 1.0 : -1.0;
    const double from = levels_.rising ? levels_.low.si() : -levels_.high.si();
    const double to = levels_.rising ? levels_.high.si() : -levels_.low.si();
    const double middle = 0.5 * (from + to);
    std::vector<double> edges;
    for (const double volt : volts) {
        const double value = sign * volt;
        // The last crossing before the far level is reached: noise may cross the middle more than once.
        if (samples_ > 0 && last_ < middle && value >= middle)
            crossing_ = static_cast<double>(samples_ - 1) + (middle - last_) / (value - last_);
        if (value <= from) armed_ = true;
        if (armed_ && value >= to) {
            edges.push_back(crossing_);
            armed_ = false;
        }
        last_ = value;
        ++samples_;
    }
    return edges;
}

}  // namespace ilf::devices
