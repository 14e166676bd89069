// A lens whose response to every harmonic is known in closed form: one resonance, and a bend where asked for.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "core/lens/shaped_wave.h"

namespace ilf {

struct SecondOrderLens {
    double rest_D = 0.5, static_D = 160.0;  ///< at no drive; for each unit of drive
    double resonance_Hz = 64.0, damping = 0.3;
    double bend = 0.0;     ///< what comes out is p + bend p^2
    double noise_D = 0.0;  ///< of one sample of a record

    std::complex<double> gain(int harmonic, Hertz rate) const {
        const std::complex<double> s(0.0, harmonic * rate.si() / resonance_Hz);
        return static_D / (1.0 + 2.0 * damping * s + s * s);
    }
    double power(const Harmonics& drive, Hertz rate, double x) const {
        double p = rest_D;
        for (std::size_t k = 0; k < drive.c.size(); ++k) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) * x;
            p += (gain(static_cast<int>(k), rate) * drive.c[k] * std::polar(1.0, angle)).real();
        }
        return p + bend * p * p;
    }
    /// The response as identification should find it; of a lens without bend.
    LensResponse response(Hertz rate, int harmonics) const {
        LensResponse r{rate, DriveUnit::volt, rest_D, {}};
        for (int k = 0; k <= harmonics; ++k)
            r.gain.push_back(gain(k, rate));
        return r;
    }
    LensRecord recorded(const Harmonics& drive, Hertz rate, unsigned seed) const {
        LensRecord record;
        record.rate = rate;
        record.drive = drive;
        record.noise_D = noise_D;
        record.temperature_C = 31.0;
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, 1.0);
        for (int i = 0; i < 250; ++i)
            record.power_D.push_back(power(drive, rate, i / 250.0) + noise_D * noise(random));
        return record;
    }
    RecordLens recorder() const {
        return [lens = *this, seed = 0U](const Harmonics& drive, Hertz rate) mutable -> Result<LensRecord> {
            return lens.recorded(drive, rate, ++seed);
        };
    }
};

/// About what 0.29 A through 2.4 A/V allows.
inline DriveLimits usualLimits() { return {0.12, 0.085, Dioptre::fromSi(-10.0), Dioptre::fromSi(10.0)}; }

}  // namespace ilf
