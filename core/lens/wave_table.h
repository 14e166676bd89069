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
    Harmonics power;                         ///< D, as recorded, at `temperature_C`
    double temperature_C = 30.0;
};

/// Extremes lie apart from the waves, side by side: a query reads nothing else until a wave is chosen.
struct WaveTable {
    Hertz rate = 60.0_Hz;
    std::vector<TableWave> waves;
    std::vector<double> low_D, high_D;  ///< of each wave, as recorded
};

/// Families other than sine, other rates than the first's and NaN samples are refused.
Result<WaveTable> waveTable(std::span<const LensRecord> records);

/// The paper's rule: of the waves whose range, `shift` dioptres added (temperature), covers [low, high], the one with
/// the least (range rounded to 1 mD, slot rms, largest |drive|, id), compared in this order. Index, or none. `slotRms`
/// judges ties; it is asked only when ranges tie.
std::optional<std::size_t> narrowestCovering(const WaveTable& table, double low, double high, double shift,
                                             double slotLength);

/// The least e_focus^2 + e_blur^2 (rms power errors of slots of `slotLength` sweeps centred on the extremes, against
/// `low` and `high`) of the waves whose extremes lie within 0.6 D of both. Index, or none.
std::optional<std::size_t> leastSlotError(const WaveTable& table, double low, double high, double shift,
                                          double slotLength);

}  // namespace ilf
