#include "core/perceived/seam_weighting.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace ilf {

double contrastSensitivity(double cyclesPerDegree) {
    const auto printed = [](double f) { return 2.6 * (0.0192 + 0.114 * f) * std::exp(-std::pow(0.114 * f, 1.1)); };
    constexpr double kPeakAt = 7.9;
    return printed(cyclesPerDegree) / printed(kPeakAt);
}

SeamWeighting::SeamWeighting(double step_deg, int samples) : kernel_(static_cast<std::size_t>(samples)) {
    // The sum over frequencies repeats after 1 / spacing: four profiles away.
    constexpr double kHighest = 40.0;
    const double spacing = 1.0 / (4.0 * step_deg * samples);
    const double highest = std::min(kHighest, 0.5 / step_deg);
    const int count = std::max(1, static_cast<int>(highest / spacing));
    for (int j = 0; j < count; ++j) {
        const double f = (j + 0.5) * highest / count;
        const double weight = 2.0 * contrastSensitivity(f) * highest / count * step_deg;
        for (std::size_t n = 0; n < kernel_.size(); ++n)
            kernel_[n] += weight * std::cos(2.0 * std::numbers::pi * f * step_deg * static_cast<double>(n));
    }
}

double SeamWeighting::worst(const std::vector<double>& differences) const {
    const int count = static_cast<int>(differences.size()), reach = static_cast<int>(kernel_.size()) - 1;
    double most = 0.0;
    for (int i = 0; i < count; ++i) {
        double sum = 0.0;
        for (int k = -reach; k <= reach; ++k) {
            sum += kernel_[static_cast<std::size_t>(std::abs(k))] *
                   differences[static_cast<std::size_t>(std::clamp(i + k, 0, count - 1))];
        }
        most = std::max(most, std::abs(sum));
    }
    return most;
}

}  // namespace ilf
