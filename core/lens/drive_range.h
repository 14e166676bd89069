// Which drives a lens must be recorded with so that its waves reach from one power to another.
#pragma once

#include "core/lens/continuous_model.h"
#include "core/lens/record.h"

namespace ilf {

/// A triangle for `drivesToRecord`: steady drives from `low` to `high`, sines about their middle up to
/// `largestAmplitude`.
struct DriveRange {
    double low = 0.0, high = 0.0, largestAmplitude = 0.0;
};

/// Feels its way with about ten records from small drives to large ones: steady powers of `powerLow_D` and
/// `powerHigh_D`, and a sine about their middle that swings as far. Less where `limits` end it. Fails when a record
/// does, or when the lens does not answer.
Result<DriveRange> driveRange(const RecordLens& record, Hertz rate, double powerLow_D, double powerHigh_D,
                              const DriveLimits& limits);

/// `count` records of that range.
Result<std::vector<LensRecord>> recordedRange(const RecordLens& record, Hertz rate, const DriveRange& range,
                                              std::size_t count = 40);

/// u(x) = offset + amplitude sin(2 pi x)
Harmonics sineDrive(const SineDrive& drive);

}  // namespace ilf
