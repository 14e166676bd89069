#include "projects/wave_period.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/lens/harmonics.h"

namespace ilf::projects {
namespace {

constexpr double kPeriodTolerance = 1e-3;
constexpr double kSmallestJump_D = 0.005;
/// A lens does not follow faster than this many harmonics (0.014 D are left of the worst, scheduling 1.2).
constexpr std::size_t kHarmonics = 16;

std::string shortly(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

/// What the first harmonics leave over.
std::vector<double> remainder(std::span<const double> values) {
    const std::vector<double> smooth = samplesOf(harmonicsOf(values, kHarmonics), values.size());
    std::vector<double> out;
    for (std::size_t i = 0; i < values.size(); ++i)
        out.push_back(values[i] - smooth[i]);
    return out;
}

}  // namespace

std::optional<NotAPeriod> notAPeriod(std::span<const double> time_s, double rate_Hz) {
    double widest = 0.0;
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double step = time_s[i] - time_s[i - 1];
        if (!(step > 0.0)) {
            return NotAPeriod{i, "time does not increase: " + shortly(time_s[i]) + " s after " +
                                     shortly(time_s[i - 1]) + " s."};
        }
        widest = std::max(widest, step);
    }
    const double period = 1.0 / rate_Hz, span = time_s.back() - time_s.front();
    const double mean = span / static_cast<double>(time_s.size() - 1);
    const auto wrong = [&](double is) {
        return NotAPeriod{time_s.size() - 1, "the period is " + shortly(1e3 * is) + " ms; at " + shortly(rate_Hz) +
                                                 " Hz it must be " + shortly(1e3 * period) + " ms within 0.1 %."};
    };
    if (widest <= 1.01 * mean) {
        const double is = span + mean;
        if (std::abs(is - period) > kPeriodTolerance * period) return wrong(is);
        return std::nullopt;
    }
    if (span >= period || period - span > widest + kPeriodTolerance * period) return wrong(span);
    return std::nullopt;
}

bool equallySpaced(std::span<const double> time_s, double rate_Hz) {
    const double step = 1.0 / (rate_Hz * static_cast<double>(time_s.size()));
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        // The clock may be off by what a period may be off; a sample may not.
        if (std::abs(time_s[i] - static_cast<double>(i) * step) > 0.01 * step + kPeriodTolerance * time_s[i])
            return false;
    }
    return true;
}

std::vector<double> resampled(std::span<const double> time_s, std::span<const double> values, double rate_Hz) {
    const auto n = static_cast<std::ptrdiff_t>(time_s.size());
    const double period = 1.0 / rate_Hz;
    const auto timeOf = [&](std::ptrdiff_t i) {
        const std::ptrdiff_t turns = i >= 0 ? i / n : -((n - 1 - i) / n);
        return time_s[static_cast<std::size_t>(i - turns * n)] + static_cast<double>(turns) * period;
    };
    const auto valueOf = [&](std::ptrdiff_t i) { return values[static_cast<std::size_t>(((i % n) + n) % n)]; };
    std::vector<double> out(kTableSamples);
    for (std::size_t k = 0; k < kTableSamples; ++k) {
        const double t = period * static_cast<double>(k) / static_cast<double>(kTableSamples);
        // Sample `right` is the first after t, counted on into the next periods or back.
        const double turns = std::floor((t - time_s.front()) / period);
        const double inside = t - turns * period;
        const std::ptrdiff_t right = std::upper_bound(time_s.begin(), time_s.end(), inside) - time_s.begin();
        double sum = 0.0;
        for (std::ptrdiff_t i = right - 2; i < right + 2; ++i) {
            double weight = 1.0;
            for (std::ptrdiff_t j = right - 2; j < right + 2; ++j) {
                if (j != i) weight *= (inside - timeOf(j)) / (timeOf(i) - timeOf(j));
            }
            sum += weight * valueOf(i);
        }
        out[k] = sum;
    }
    return out;
}

double noiseOf(std::span<const double> values) {
    std::vector<double> sizes;
    for (std::size_t i = 3; i < values.size(); ++i)
        sizes.push_back(std::abs(values[i] - 3.0 * values[i - 1] + 3.0 * values[i - 2] - values[i - 3]));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    // Third differences of white noise have 20 times its variance; the median of |normal| is 0.6745 sigma.
    return *middle / (0.6745 * std::sqrt(20.0));
}

std::optional<double> jumpAtSeam(std::span<const double> power_D, double noise_D) {
    const std::size_t n = power_D.size();
    // A wave that ends higher than it began is one that repeats plus a ramp, and of a ramp the first harmonics leave
    // over what no lens does. How much of that is in the wave, for a seam at each place:
    std::vector<double> ramp;
    for (std::size_t i = 0; i < n; ++i)
        ramp.push_back(static_cast<double>(i) / static_cast<double>(n));
    const std::vector<double> trace = remainder(ramp), left = remainder(power_D);
    double square = 0.0;
    for (const double t : trace)
        square += t * t;
    const auto jumpAt = [&](std::size_t place) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            sum += trace[i] * left[(i + place) % n];
        return std::abs(sum / square);
    };
    const double jump = jumpAt(0);
    double elsewhere = 0.0;
    for (std::size_t place = n / kHarmonics; place <= n - n / kHarmonics; ++place)
        elsewhere = std::max(elsewhere, jumpAt(place));
    if (jump <= 3.0 * noise_D || jump <= 1.5 * elsewhere || jump <= kSmallestJump_D) return std::nullopt;
    return jump;
}

}  // namespace ilf::projects
