// Recorded sine waves of one rate, and the paper's way to choose among them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/lens/record.h"

namespace ilf {

/// One recorded wave, ready to be chosen.
struct TableWave {
    std::int64_t id = 0;
    double driveLow = 0.0, driveHigh = 0.0;  ///< u(x) = middle + half (high - low) sin(2 pi x)
    Harmonics power;                         ///< D, corrected to the table's temperature at rest
    double temperature_C = 30.0;             ///< of the coil when it was recorded
};

/// Extremes and slots lie apart from the waves, side by side: a query reads nothing else until a wave is chosen. Waves
/// of narrower range come first, so that the narrowest that covers is the first that does.
struct WaveTable {
    Hertz rate = 60.0_Hz;
    /// Of the lens at rest while it was recorded. What a wave's own drive warms the coil by is part of its record.
    double temperature_C = 30.0;
    std::vector<TableWave> waves;
    std::vector<double> low_D, high_D;  ///< of each wave
    /// Slots of `slotLength` sweeps centred on the extremes: where (x), and mean (D) and variance (D^2) of the power.
    struct Slots {
        std::vector<double> centre, mean, variance;
    } atLow, atHigh;
    double slotLength = 1.0 / 16.0;
};

/// Families other than sine, other rates than the first's and NaN samples are refused, and so is no record at all.
/// Where the room grew warmer while recording, powers are levelled by `drift_D_per_C`; slots of another length than
/// `slotLength` are judged too, but slower.
Result<WaveTable> waveTable(std::span<const LensRecord> records, double drift_D_per_C = 0.033,
                            double slotLength = 1.0 / 16.0);

/// The paper's rule: of the waves whose range, `shift` dioptres added (temperature), covers [low, high], the one with
/// the least (range rounded to 1 mD, slot rms, largest |drive|, id), compared in this order. Index, or none. The slot
/// rms is the one of `leastSlotError`; it is judged only when ranges tie. Waves beyond `limits` are left out.
std::optional<std::size_t> narrowestCovering(const WaveTable& table, double low, double high, double shift,
                                             double slotLength, const DriveLimits* limits = nullptr);

/// The least e_focus^2 + e_blur^2 (rms power errors of slots of `slotLength` sweeps centred on the extremes, against
/// `low` and `high`) of the waves whose extremes lie within 0.6 D of both; then the largest |drive| and the id. Index,
/// or none. Waves beyond `limits` are left out.
std::optional<std::size_t> leastSlotError(const WaveTable& table, double low, double high, double shift,
                                          double slotLength, const DriveLimits* limits = nullptr);
/// How far from a target an extreme may lie to be considered (scheduling 1.3).
inline constexpr double kNear_D = 0.6;

/// e_focus^2 + e_blur^2 of wave `index`, as above, in D^2.
double slotError(const WaveTable& table, std::size_t index, double low, double high, double shift, double slotLength);

/// Whether the lens may play wave `index`: power within the lens's limits, peak and rms of the drive within its own.
bool playable(const WaveTable& table, std::size_t index, double shift, const DriveLimits& limits);

}  // namespace ilf
