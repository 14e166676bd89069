// Waves of several harmonics that hold the lens at its levels: designed on an identified lens, then learnt on it.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// The lens about an operating point: harmonic k of the power is gain[k] times harmonic k of the drive (k >= 1), and
/// the mean is bias + gain[0] times the drive's mean.
struct LensResponse {
    Hertz rate = 60.0_Hz;
    DriveUnit unit = DriveUnit::volt;
    double bias_D = 0.0;
    std::vector<std::complex<double>> gain;
};

/// Records three multisines and fits `harmonics` gains: two weak ones, then one about the operating point (mean power
/// `middle`, swing `swing`) with the spectrum of a wave that holds two levels. Refuses a lens that does not answer.
Result<LensResponse> identified(const RecordLens& record, Hertz rate, double middle_D, double swing_D, int harmonics,
                                const DriveLimits& limits);

/// A time the lens shall spend at one power.
struct Hold {
    double centre = 0.0, length = 0.0;  ///< in sweeps
    double power_D = 0.0;
    bool operator==(const Hold&) const = default;
};
/// Holds for `levels` ascending, `duty` of the sweep for each, the lowest about `lowAt`: every other level on the way
/// up, the rest on the way down, which takes the fewest and lowest steps. With two levels the holds lie half a sweep
/// apart.
std::vector<Hold> holdsFor(std::span<const double> levels_D, double duty, double lowAt);
/// Refuses none, holds that do not fit in one sweep or overlap, and numbers that are not finite.
Result<void> checkedHolds(std::span<const Hold> holds);
/// The largest |power - level| inside the holds, sampled 512 times a sweep and at the holds' ends.
double largestErrorIn(std::span<const Hold> holds, const Harmonics& power);

struct ShapedDesign {
    Harmonics drive, power;  ///< power as predicted by the response
    double largestError_D = 0.0;
};
/// The drive of at most `harmonics` harmonics whose predicted largest error inside the holds is least, its peak and rms
/// and the lens's power within the limits (scheduling 3.4; solved as a convex problem, see minimax.h). Refuses
/// levels the limits keep out of reach.
Result<ShapedDesign> designed(const LensResponse& response, std::span<const Hold> holds, int harmonics,
                              const DriveLimits& limits);

/// A wave learnt on the lens: recorded, not predicted.
struct ShapedWave {
    std::int64_t id = 0;  ///< in its database; 0: in none
    Hertz rate = 60.0_Hz;
    DriveUnit unit = DriveUnit::volt;
    std::vector<Hold> holds;
    Harmonics drive, power;        ///< power as recorded with this drive
    double largestError_D = 0.0;   ///< inside the holds, of the recorded power
    std::vector<double> errors_D;  ///< of the first play and after each iteration
    double temperature_C = 30.0;
    Provenance provenance = Provenance::simulated;
};

/// Identifies, designs and plays, then corrects the drive towards the design made again about the last record
/// (iterative learning, gain 0.7), at most `iterations` times; stops when a record is worse than the best before and
/// keeps the best. At most 4 + `iterations` records. A DAC whose rate is no multiple of `rate` adds ripple that differs
/// from sweep to sweep; averaged records do not show it and nothing can learn it.
Result<ShapedWave> learnt(const RecordLens& record, Hertz rate, std::span<const Hold> holds, int harmonics,
                          const DriveLimits& limits, int iterations = 4);

}  // namespace ilf
