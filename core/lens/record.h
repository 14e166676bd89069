// One recorded period of a lens, and the way to get one: play a drive, wait until it repeats, sample.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/lens/waveform.h"

namespace ilf {

/// What a photodiode (or an emulator of one) gives: noisy samples of one period, averaged over several.
struct LensRecord {
    std::int64_t id = 0;          ///< in its database; 0: in none
    std::string family = "sine";  ///< sine, multisine, shaped
    Hertz rate;
    Harmonics drive;  ///< x = 0 at sample 0; for family sine: offset and one harmonic -i a, u = o + a sin(2 pi x)
    DriveUnit unit = DriveUnit::volt;
    std::vector<double> power_D;  ///< equally spaced over one period
    double temperature_C = 30.0;  ///< of the lens, as its sensor said
    int periodsAveraged = 1;
    double noise_D = 0.0;  ///< standard deviation of one sample after averaging
    Provenance provenance = Provenance::simulated;
    bool operator==(const LensRecord&) const = default;
};

/// Plays `drive` at `rate` on a lens until it repeats, and records it. Fails when the drive is beyond the lens's
/// limits.
using RecordLens = std::function<Result<LensRecord>(const Harmonics& drive, Hertz rate)>;

/// What must never be exceeded, in the drive's unit, and the lens's own limits of power.
struct DriveLimits {
    double peak = 0.0;  ///< largest |drive|
    double rms = 0.0;   ///< largest rms over a period
    Dioptre lensMin = -10.0_D, lensMax = 10.0_D;
    bool operator==(const DriveLimits&) const = default;
};

}  // namespace ilf
