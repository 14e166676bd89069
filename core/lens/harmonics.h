// One period of a real signal as a Fourier series: a lens's power in dioptres, or what drives it.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace ilf {

/// f(x) = Re c[0] + sum over k >= 1 of Re(c[k] e^(2 pi i k x)), x in periods. Empty is 0 everywhere.
struct Harmonics {
    std::vector<std::complex<double>> c;
    bool operator==(const Harmonics&) const = default;

    double at(double x) const;
    /// Change of f for each period.
    double slopeAt(double x) const;
    double mean() const { return c.empty() ? 0.0 : c[0].real(); }
    /// Of the whole period, mean included.
    double rms() const;
    /// g(x) = f(x - delay).
    Harmonics delayed(double delay) const;
    /// Closed form, exact to rounding; `length` above 0.
    double meanOver(double start, double length) const;
};

bool isFinite(const Harmonics& f);
/// Running mean: g(x) is the mean of f from x - length / 2 to x + length / 2.
Harmonics averaged(Harmonics f, double length);
/// f^2, with twice as many harmonics. Its `meanOver` gives mean squares over slots in closed form.
Harmonics squared(const Harmonics& f);
/// f - constant.
Harmonics lessConstant(Harmonics f, double constant);

struct Extremes {
    double low = 0.0, high = 0.0;
    double atLow = 0.0, atHigh = 0.0;  ///< in periods, 0 <= x < 1
};
/// Sampled, then refined by Newton steps: exact to rounding unless two extremes lie nearer than 1/1024 of a period.
Extremes extremes(const Harmonics& f);

/// Least squares through equally spaced samples, sample 0 at x = 0. Precondition: 2 count < samples.size().
Harmonics harmonicsOf(std::span<const double> samples, std::size_t count);
/// f at x = 0, 1/n, 2/n, ...
std::vector<double> samplesOf(const Harmonics& f, std::size_t n);

}  // namespace ilf
