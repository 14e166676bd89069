#include "devices/measure/power_scale.h"

#include <algorithm>
#include <cmath>

namespace ilf::devices {
namespace {

/// Least squares of a polynomial through (x, y), |x| about 1 at most.
std::vector<double> fitted(const std::vector<double>& x, const std::vector<double>& y, std::size_t terms) {
    std::vector<std::vector<double>> rows(terms, std::vector<double>(terms + 1, 0.0));
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t r = 0; r < terms; ++r) {
            for (std::size_t c = 0; c < terms; ++c)
                rows[r][c] += std::pow(x[i], static_cast<double>(r + c));
            rows[r][terms] += y[i] * std::pow(x[i], static_cast<double>(r));
        }
    }
    for (std::size_t r = 0; r < terms; ++r) {
        std::size_t pivot = r;
        for (std::size_t other = r + 1; other < terms; ++other) {
            if (std::abs(rows[other][r]) > std::abs(rows[pivot][r])) pivot = other;
        }
        std::swap(rows[r], rows[pivot]);
        for (std::size_t other = 0; other < terms; ++other) {
            if (other == r) continue;
            const double factor = rows[other][r] / rows[r][r];
            for (std::size_t c = r; c <= terms; ++c)
                rows[other][c] -= factor * rows[r][c];
        }
    }
    std::vector<double> result(terms);
    for (std::size_t r = 0; r < terms; ++r)
        result[r] = rows[r][terms] / rows[r][r];
    return result;
}

}  // namespace

double PowerScale::powerAt(double volts) const {
    if (!(volts > dark_V)) return NAN;
    const double x = (1.0 / std::sqrt(volts - dark_V) - middle) / span;
    double power = 0.0;
    for (std::size_t i = terms.size(); i-- > 0;)
        power = power * x + terms[i];
    return power;
}

double PowerScale::slopeAt(double volts) const {
    const double step = 1e-4 * (volts - dark_V);
    return 2.0 * step / (powerAt(volts + step) - powerAt(volts - step));
}

Result<PowerScale> powerScale(std::span<const VoltsAtPower> known, double dark_V) {
    if (known.size() < 2)
        return fail(Fault::outOfRange, "At least two powers of the lens must be known, at currents that lie apart.");
    std::vector<VoltsAtPower> sorted(known.begin(), known.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.power_D < b.power_D; });
    PowerScale scale;
    scale.dark_V = dark_V;
    std::vector<double> x, y;
    for (const VoltsAtPower& one : sorted) {
        if (!(one.volts > dark_V) || !std::isfinite(one.power_D))
            return fail(Fault::device,
                        "The light through the lens is not brighter than the dark; switch the laser on.");
        x.push_back(1.0 / std::sqrt(one.volts - dark_V));
        y.push_back(one.power_D);
    }
    const bool rises = x.back() > x.front();
    for (std::size_t i = 1; i < x.size(); ++i) {
        if ((x[i] > x[i - 1]) != rises || x[i] == x[i - 1] || !(y[i] > y[i - 1]))
            return fail(Fault::device,
                        "The light does not go one way with the lens's known powers. Check those numbers and their "
                        "currents, the beam through the lens's middle, and that the photodiode lies inside the beam.");
    }
    const auto [least, most] = std::minmax(x.front(), x.back());
    scale.middle = 0.5 * (least + most);
    scale.span = 0.5 * (most - least);
    for (double& value : x)
        value = (value - scale.middle) / scale.span;
    scale.terms = fitted(x, y, std::min<std::size_t>(4, x.size() < 3 ? 2 : x.size() < 5 ? 3 : 4));
    scale.low_D = sorted.front().power_D;
    scale.high_D = sorted.back().power_D;
    for (const VoltsAtPower& one : sorted)
        scale.largestMiss_D = std::max(scale.largestMiss_D, std::abs(scale.powerAt(one.volts) - one.power_D));
    return scale;
}

}  // namespace ilf::devices
