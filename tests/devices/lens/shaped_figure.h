// How well a learnt wave holds a simulated lens, judged on the lens itself and not by the records it was learnt from.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/lens/shaped_wave.h"
#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {

/// The case: levels at 0 and 2.2 D.
struct ShapedCase {
    Hertz rate = 60.0_Hz;
    double duty = 0.30;  ///< of each level
    int harmonics = 5;
    std::array<double, 2> levels_D{0.0, 2.2};

    std::vector<Hold> holds() const { return holdsFor(levels_D, duty, 0.1); }
};
/// Largest error allowed in the holds.
inline double allowed_D(LensPreset preset) { return preset == LensPreset::dirty ? 0.06 : 0.05; }

/// Nine sweeps, free of noise, once the lens is warm and repeats; 1 kHz and 60 or 90 Hz fall together within nine.
inline std::vector<std::vector<double>> sweepsOf(LensEmulator lens, const Harmonics& drive, Hertz rate) {
    constexpr int kSweeps = 9, kSamples = 1000;
    const double period = 1.0 / rate.si();
    lens.play(drive, rate);
    lens.warmUp();
    lens.advance(Second::fromSi(std::ceil(0.3 / period) * period));
    std::vector<std::vector<double>> sweeps(kSweeps);
    for (auto& sweep : sweeps) {
        for (int i = 0; i < kSamples; ++i) {
            sweep.push_back(lens.power().si());
            lens.advance(Second::fromSi(period / kSamples));
        }
    }
    return sweeps;
}

inline std::vector<double> averageOf(const std::vector<std::vector<double>>& sweeps) {
    std::vector<double> average(sweeps[0].size());
    for (const auto& sweep : sweeps)
        for (std::size_t i = 0; i < sweep.size(); ++i)
            average[i] += sweep[i] / static_cast<double>(sweeps.size());
    return average;
}

inline double largestErrorIn(std::span<const Hold> holds, const std::vector<double>& sweep) {
    double largest = 0.0;
    for (std::size_t i = 0; i < sweep.size(); ++i) {
        for (const Hold& hold : holds) {
            const double away = static_cast<double>(i) / static_cast<double>(sweep.size()) - hold.centre;
            if (std::abs(away - std::round(away)) <= 0.5 * hold.length)
                largest = std::max(largest, std::abs(sweep[i] - hold.power_D));
        }
    }
    return largest;
}

struct ShapedFigure {
    ShapedWave wave;
    double averaged_D = 0.0;   ///< largest error in the holds of the average sweep
    double eachSweep_D = 0.0;  ///< of the worst single sweep: ripple of a DAC that beats with the rate included
    double peak_A = 0.0, rms_A = 0.0;
};

/// Learns a wave from noisy records (0.02 D before averaging eight sweeps) and judges it.
inline Result<ShapedFigure> shapedFigure(LensPreset preset, std::uint64_t seed, const ShapedCase& what) {
    const LensParameters parameters = lensParameters(preset, seed);
    LensEmulator lens(parameters);
    RecordOptions options;
    options.seed = 1000 * seed + 1;
    auto wave = learnt(recorder(lens, options), what.rate, what.holds(), what.harmonics, lens.limits());
    if (!wave) return tl::unexpected(wave.error());
    ShapedFigure figure;
    const auto sweeps = sweepsOf(lens, wave->drive, what.rate);
    figure.averaged_D = largestErrorIn(wave->holds, averageOf(sweeps));
    for (const auto& sweep : sweeps)
        figure.eachSweep_D = std::max(figure.eachSweep_D, largestErrorIn(wave->holds, sweep));
    const Extremes ends = extremes(wave->drive);
    figure.peak_A = parameters.amplifier_A_per_V * std::max(std::abs(ends.low), std::abs(ends.high));
    figure.rms_A = parameters.amplifier_A_per_V * wave->drive.rms();
    figure.wave = *std::move(wave);
    return figure;
}

/// Part of the sweep that a sine stays within `error_D` of each level, its extremes `beyond_D` outside them: 0 is how
/// sweeps are planned, `error_D` the most a sine can do. Found on the lens itself, without noise: the best that could
/// be said for the sine.
inline double sineDuty(LensPreset preset, std::uint64_t seed, const ShapedCase& what, double error_D, double beyond_D) {
    LensEmulator lens(lensParameters(preset, seed));
    const auto [low, high] = what.levels_D;
    Harmonics drive{{0.0, {0.0, -0.005}}};
    std::vector<double> sweep;
    for (int i = 0; i < 12; ++i) {
        sweep = averageOf(sweepsOf(lens, drive, what.rate));
        const auto [least, most] = std::ranges::minmax(sweep);
        drive.c[1] *= (high - low + 2.0 * beyond_D) / (most - least);
        // 165 D/V is the table's slope at rest; any near value converges.
        drive.c[0] += (0.5 * (low + high) - 0.5 * (least + most)) / 165.0;
    }
    const auto within = [&](double level) {
        return static_cast<double>(
                   std::ranges::count_if(sweep, [&](double p) { return std::abs(p - level) <= error_D; })) /
               static_cast<double>(sweep.size());
    };
    return std::min(within(low), within(high));
}

}  // namespace ilf::devices
