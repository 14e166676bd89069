// What shaping reads off one record: the lens's power as harmonics, noise left out.
#pragma once

#include "core/lens/record.h"

namespace ilf {

struct RecordedPower {
    Harmonics power;  ///< D; 16 harmonics or as many as asked for, fewer where the record has too few samples
    DriveUnit unit = DriveUnit::volt;
    double noise_D = 0.0;  ///< standard deviation of `power` at any one time
    double temperature_C = 30.0;
    Provenance provenance = Provenance::simulated;
};

/// Plays and records `drive`. Refuses a drive beyond the limits before it is played, and records that are too short for
/// `harmonics` or hold numbers that are not finite.
Result<RecordedPower> recordedPower(const RecordLens& record, const Harmonics& drive, Hertz rate, int harmonics,
                                    const DriveLimits& limits);

/// Largest |f| of a period.
double peakOf(const Harmonics& f);

}  // namespace ilf
