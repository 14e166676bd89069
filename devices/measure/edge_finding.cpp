#include <algorithm>
#include <cmath>

#include "devices/measure/edge_delay.h"

namespace ilf::devices {
namespace {

// Edges are looked for among slopes at least this strong, of the usual edge's of their kind: light often comes slower
// than it goes.
constexpr double kLeastStrength = 0.4;
constexpr double kLeastContrast = 6.0;
// Stretches in which the strongest slope is looked at: a second of edges has ten.
constexpr double kStretch_s = 0.1;

double quantile(std::vector<double>& values, double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

/// Derivative of a Gaussian, for a slope in volts a sample.
std::vector<double> slopeKernel(double sigma) {
    const int reach = static_cast<int>(std::ceil(3.5 * sigma));
    std::vector<double> kernel;
    double sum = 0.0;
    for (int i = -reach; i <= reach; ++i) {
        const double value = i * std::exp(-0.5 * i * i / (sigma * sigma));
        kernel.push_back(value);
        sum += value * i;
    }
    for (double& value : kernel)
        value /= sum;
    return kernel;
}

std::vector<double> slopesOf(std::span<const double> volts, const std::vector<double>& kernel) {
    const std::size_t reach = kernel.size() / 2;
    std::vector<double> slopes(volts.size(), 0.0);
    for (std::size_t i = reach; i + reach < volts.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < kernel.size(); ++k)
            sum += kernel[k] * volts[i + k - reach];
        slopes[i] = sum;
    }
    return slopes;
}

/// Standard deviation of white noise, from second differences, which neither light nor drift reach between edges.
double noiseOf(std::span<const double> volts) {
    std::vector<double> differences;
    for (std::size_t i = 2; i < volts.size(); ++i)
        differences.push_back(std::abs(volts[i] - 2.0 * volts[i - 1] + volts[i - 2]));
    return differences.empty() ? 0.0 : quantile(differences, 0.5) * 1.4826 / std::sqrt(6.0);
}

/// The usual edge's slope, of the rising (`sign` 1) or falling (-1) ones.
double usualSlope(const std::vector<double>& slopes, double sign, double samplesPerSecond) {
    const auto stretch = std::max<std::size_t>(8, static_cast<std::size_t>(kStretch_s * samplesPerSecond));
    std::vector<double> strongest;
    for (std::size_t at = 0; at < slopes.size(); at += stretch) {
        double most = 0.0;
        for (std::size_t i = at; i < std::min(at + stretch, slopes.size()); ++i)
            most = std::max(most, sign * slopes[i]);
        strongest.push_back(most);
    }
    return quantile(strongest, 0.75);
}

/// Where the parabola through a peak and its neighbours is highest.
double peakAt(const std::vector<double>& slopes, std::size_t i) {
    if (i == 0 || i + 1 >= slopes.size()) return static_cast<double>(i);
    const double bend = slopes[i - 1] - 2.0 * slopes[i] + slopes[i + 1];
    const double off = bend == 0.0 ? 0.0 : 0.5 * (slopes[i - 1] - slopes[i + 1]) / bend;
    return static_cast<double>(i) + std::clamp(off, -0.5, 0.5);
}

}  // namespace

Result<FoundEdges> edgesOf(std::span<const double> volts, double samplesPerSecond, Second shortest) {
    if (!(samplesPerSecond > 0.0) || !(shortest > Second()) || volts.size() < 16)
        return fail(Fault::outOfRange, "There is too little of the recording to look for edges in.");
    const double sigma = std::max(0.8, shortest.si() * samplesPerSecond / 6.0);
    const auto kernel = slopeKernel(sigma);
    const auto slopes = slopesOf(volts, kernel);
    const double usual[2] = {usualSlope(slopes, -1.0, samplesPerSecond), usualSlope(slopes, 1.0, samplesPerSecond)};
    const double faintest = std::min(usual[0], usual[1]);
    double gain = 0.0;
    for (const double value : kernel)
        gain += value * value;
    if (!(faintest > 0.0))
        return fail(Fault::device, "The light never changes. Check that the photodiode sees the pattern and is wired.");
    FoundEdges found;
    const double noise = noiseOf(volts) * std::sqrt(gain);
    found.contrast = noise > 0.0 ? std::min(faintest / noise, 1e6) : 1e6;
    if (found.contrast < kLeastContrast)
        return fail(
            Fault::device,
            "No edges stand out of the noise. Bring the photodiode nearer to the light, shade it from the room, "
            "or check that the pattern plays.");

    const auto keep = [&](std::size_t at, bool rising) {
        const LightEdge edge{peakAt(slopes, at) / samplesPerSecond, rising,
                             std::abs(slopes[at]) / usual[rising ? 1 : 0]};
        if (found.edges.empty() || found.edges.back().rising != rising) {
            found.edges.push_back(edge);
        } else if (found.edges.back().strength < edge.strength) {
            // The other edge between them was too faint to count, or they are one: the stronger stays.
            found.edges.back() = edge;
        }
    };
    for (std::size_t i = 0; i < slopes.size();) {
        const bool rising = slopes[i] > 0.0;
        const double sign = rising ? 1.0 : -1.0, least = kLeastStrength * usual[rising ? 1 : 0];
        if (sign * slopes[i] < least) {
            ++i;
            continue;
        }
        std::size_t steepest = i;
        for (; i < slopes.size() && sign * slopes[i] >= least; ++i) {
            if (sign * slopes[i] > sign * slopes[steepest]) steepest = i;
        }
        keep(steepest, rising);
    }
    return found;
}

Spread spreadOf(std::vector<double> times) {
    if (times.empty()) return {};
    Spread spread;
    const double median = quantile(times, 0.5);
    spread.median = Second::fromSi(median);
    spread.low = Second::fromSi(quantile(times, 0.05));
    spread.high = Second::fromSi(quantile(times, 0.95));
    for (double& time : times)
        time = std::abs(time - median);
    spread.deviation = Second::fromSi(1.4826 * quantile(times, 0.5));
    return spread;
}

}  // namespace ilf::devices
