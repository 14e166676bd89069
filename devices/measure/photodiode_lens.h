// A lens before a photodiode, measured: its powers at rest over the current, then waves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/document/rig_devices.h"
#include "core/lens/record.h"
#include "devices/measure/lens_bench.h"
#include "devices/measure/power_scale.h"

namespace ilf::devices {

/// What a step says while it works: "12 of 40", in words.
using MeasureSaid = std::function<void(const std::string&)>;

/// The lens stepped from its lowest known power to its highest and back.
struct StaticSweep {
    std::vector<StaticPower> powers;  ///< ascending in current: the mean of the way up and the way down
    PowerScale scale;
    double hysteresis_D = 0.0;        ///< the largest difference between the way up and the way down
    double noise_D = 0.0;             ///< standard deviation of a power, from the light's noise
    double slope_D_per_A = 0.0;       ///< mean
    double leastSlope_D_per_A = 0.0;  ///< of any step, both ways: above 0 everywhere, or it was refused
};

struct StaticSweepSetup {
    double dark_V = 0.0;
    /// From a lensmeter or the lens's certificate, at the temperature it is measured at; two or more, ascending in
    /// current. The sweep goes between the first and the last: beyond them nothing is known.
    std::vector<StaticPower> known;
    int steps = 15;  ///< evenly spaced, besides the known ones
};

/// Refused, with what to check: fewer than two known powers, no light, light that does not follow the current (which
/// lens is before the photodiode?), powers that do not rise with the current all the way, known powers that miss the
/// photodiode's scale by more than 0.15 D.
Result<StaticSweep> staticSweep(LensBench& bench, const StaticSweepSetup& setup, const MeasureSaid& said = {});

struct WaveRecording {
    PowerScale scale;
    DriveLimits limits;                     ///< in amperes
    std::function<double()> temperature_C;  ///< of the lens, now
    Provenance provenance = Provenance::measured;
    int samples = 250;  ///< of a record
};
/// What the lens may be asked for while it is measured: the currents between the ends of the static sweep, within what
/// amplifier and rig allow.
DriveLimits limitsOf(const StaticSweep& sweep, const Amplifier& amplifier, Dioptre lensMin, Dioptre lensMax);

/// Plays drives in amperes and records them. Powers beyond the known ones by more than a quarter of their range are
/// refused: the scale was never seen there. `bench` must outlive it.
RecordLens photodiodeRecorder(LensBench& bench, WaveRecording setup);

/// Three drives to learn how far the lens swings at this rate, then `waves` (at least 9) that cover what limits and
/// known powers allow, as a model needs them.
Result<std::vector<LensRecord>> recordedWaves(const RecordLens& record, const StaticSweep& sweep,
                                              const DriveLimits& limits, Hertz rate, std::size_t waves,
                                              const MeasureSaid& said = {});

}  // namespace ilf::devices
