// A lens of our own for tests of what is fitted to records: a curved static answer, then a resonance, then noise.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// Periodic answers in closed form: P = resonance applied to f(u), harmonic by harmonic.
struct SyntheticLens {
    double mode_Hz = 64.0, damping = 0.30;
    double gain_D_per_V = 165.0, curved_D_per_V2 = -180.0;
    double rest_D = 0.5;

    Harmonics power(double offset, double amplitude, Hertz rate) const {
        constexpr std::size_t kSamples = 96, kHarmonics = 16;
        std::vector<double> still(kSamples);
        for (std::size_t i = 0; i < kSamples; ++i) {
            const double u =
                offset + amplitude * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / double(kSamples));
            still[i] = rest_D + u * (gain_D_per_V + u * curved_D_per_V2);
        }
        Harmonics out = harmonicsOf(still, kHarmonics);
        for (std::size_t k = 1; k <= kHarmonics; ++k) {
            const double r = static_cast<double>(k) * rate.si() / mode_Hz;
            out.c[k] /= std::complex<double>(1.0 - r * r, 2.0 * damping * r);
        }
        return out;
    }

    LensRecord record(std::int64_t id, double offset, double amplitude, Hertz rate, double noise_D = 0.0) const {
        LensRecord record;
        record.id = id;
        record.rate = rate;
        record.drive.c = {offset, {0.0, -amplitude}};
        record.power_D = samplesOf(power(offset, amplitude, rate), 250);
        record.noise_D = noise_D;
        std::mt19937_64 random(static_cast<std::uint64_t>(id));
        std::normal_distribution<double> noise(0.0, noise_D);
        if (noise_D > 0.0) {
            for (double& p : record.power_D)
                p += noise(random);
        }
        return record;
    }
};

/// The paper's waves: every (lowest, highest) pair of `count` voltages from -reach to reach.
inline std::vector<LensRecord> allWaves(const SyntheticLens& lens, int count, double reach_V, Hertz rate,
                                        double noise_D = 0.0) {
    std::vector<LensRecord> records;
    const auto volt = [&](int i) { return reach_V * (2.0 * i / (count - 1) - 1.0); };
    for (int low = 0; low < count; ++low) {
        for (int high = low + 1; high < count; ++high) {
            records.push_back(lens.record(static_cast<std::int64_t>(records.size()) + 1, 0.5 * (volt(low) + volt(high)),
                                          0.5 * (volt(high) - volt(low)), rate, noise_D));
        }
    }
    return records;
}

}  // namespace ilf
