#include "core/lens/harmonics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ilf {
namespace {

using Complex = std::complex<double>;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

Complex turn(double x) { return std::polar(1.0, kTwoPi * (x - std::floor(x))); }

/// Horner in e^(2 pi i x): Re of the sum of coefficient(k) z^k.
template <class Coefficient>
double sum(const Harmonics& f, double x, Coefficient coefficient) {
    const Complex z = turn(x);
    Complex value = 0.0;
    for (std::size_t k = f.c.size(); k-- > 0;)
        value = value * z + coefficient(k);
    return value.real();
}

Complex slopeFactor(std::size_t k) { return {0.0, kTwoPi * static_cast<double>(k)}; }

double curvatureAt(const Harmonics& f, double x) {
    return sum(f, x, [&](std::size_t k) { return f.c[k] * slopeFactor(k) * slopeFactor(k); });
}

/// Newton on the slope from the best of the samples; stays within one sample of it.
double refined(const Harmonics& f, double x, double step) {
    const double from = x - step, to = x + step;
    for (int i = 0; i < 8; ++i) {
        const double curvature = curvatureAt(f, x);
        if (curvature == 0.0) break;
        const double next = std::clamp(x - f.slopeAt(x) / curvature, from, to);
        if (next == x) break;
        x = next;
    }
    return x - std::floor(x);
}

}  // namespace

double Harmonics::at(double x) const {
    return sum(*this, x, [&](std::size_t k) { return k == 0 ? Complex(c[0].real()) : c[k]; });
}

double Harmonics::slopeAt(double x) const {
    return sum(*this, x, [&](std::size_t k) { return c[k] * slopeFactor(k); });
}

double Harmonics::rms() const {
    double square = mean() * mean();
    for (std::size_t k = 1; k < c.size(); ++k)
        square += 0.5 * std::norm(c[k]);
    return std::sqrt(square);
}

Harmonics Harmonics::delayed(double delay) const {
    Harmonics g = *this;
    for (std::size_t k = 1; k < g.c.size(); ++k)
        g.c[k] *= turn(-delay * static_cast<double>(k));
    return g;
}

double Harmonics::meanOver(double start, double length) const {
    return averaged(*this, length).at(start + 0.5 * length);
}

Harmonics averaged(Harmonics f, double length) {
    assert(length > 0.0);
    for (std::size_t k = 1; k < f.c.size(); ++k) {
        const double half = std::numbers::pi * static_cast<double>(k) * length;
        f.c[k] *= std::sin(half) / half;
    }
    return f;
}

bool isFinite(const Harmonics& f) {
    return std::ranges::all_of(f.c,
                               [](const Complex& c) { return std::isfinite(c.real()) && std::isfinite(c.imag()); });
}

Harmonics squared(const Harmonics& f) {
    Harmonics out;
    if (f.c.empty()) return out;
    const std::size_t n = f.c.size();
    out.c.resize(2 * n - 1);
    const double mean = f.mean();
    out.c[0] = mean * mean;
    for (std::size_t k = 1; k < n; ++k) {
        out.c[k] += 2.0 * mean * f.c[k];
        out.c[0] += 0.5 * std::norm(f.c[k]);
    }
    // Re(a e^ik) Re(b e^il) = Re(a b e^i(k+l)) / 2 + Re(a conj(b) e^i(k-l)) / 2
    for (std::size_t k = 1; k < n; ++k) {
        for (std::size_t l = 1; l < n; ++l)
            out.c[k + l] += 0.5 * f.c[k] * f.c[l];
        for (std::size_t l = 1; l < k; ++l)
            out.c[k - l] += f.c[k] * std::conj(f.c[l]);
    }
    return out;
}

Harmonics lessConstant(Harmonics f, double constant) {
    if (f.c.empty()) f.c.emplace_back();
    f.c[0] -= constant;
    return f;
}

Extremes extremes(const Harmonics& f) {
    if (f.c.size() <= 1) return {f.mean(), f.mean(), 0.0, 0.0};
    if (f.c.size() == 2) {  // a sine: nothing to search
        const double swing = std::abs(f.c[1]), phase = std::arg(f.c[1]) / kTwoPi;
        const auto wrapped = [](double x) { return x - std::floor(x); };
        return {f.mean() - swing, f.mean() + swing, wrapped(0.5 - phase), wrapped(-phase)};
    }
    const std::size_t n = std::max<std::size_t>(128, 16 * f.c.size());
    const std::vector<double> samples = samplesOf(f, n);
    const auto [low, high] = std::ranges::minmax_element(samples);
    const double step = 1.0 / static_cast<double>(n);
    Extremes e;
    e.atLow = refined(f, static_cast<double>(low - samples.begin()) * step, step);
    e.atHigh = refined(f, static_cast<double>(high - samples.begin()) * step, step);
    e.low = f.at(e.atLow);
    e.high = f.at(e.atHigh);
    return e;
}

Harmonics harmonicsOf(std::span<const double> samples, std::size_t count) {
    assert(2 * count < samples.size());
    Harmonics f;
    f.c.resize(count + 1);
    const double n = static_cast<double>(samples.size());
    for (std::size_t k = 0; k <= count; ++k) {
        const Complex step = std::polar(1.0, -kTwoPi * static_cast<double>(k) / n);
        Complex z = 1.0, total = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            // A product of thousands of turns drifts; every 64th is taken afresh.
            if (i % 64 == 0) z = turn(-static_cast<double>(k) * static_cast<double>(i) / n);
            total += samples[i] * z;
            z *= step;
        }
        f.c[k] = total * ((k == 0 ? 1.0 : 2.0) / n);
    }
    return f;
}

std::vector<double> samplesOf(const Harmonics& f, std::size_t n) {
    std::vector<double> samples(n);
    for (std::size_t i = 0; i < n; ++i)
        samples[i] = f.at(static_cast<double>(i) / static_cast<double>(n));
    return samples;
}

}  // namespace ilf
