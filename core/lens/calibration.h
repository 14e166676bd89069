// Everything the planner knows of a lens: its recorded waves, a model fitted to them, and the shaped waves it has
// learnt.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lens/continuous_model.h"
#include "core/lens/record.h"
#include "core/lens/shaped_wave.h"
#include "core/lens/wave_table.h"

namespace ilf {

/// Immutable once made; plans share it. One rate, one temperature each: entries of other rates lie beside it.
struct LensCalibration {
    std::string lens;  ///< "simulated lens, preset datasheet", or maker, model and serial
    Provenance provenance = Provenance::simulated;
    DriveUnit unit = DriveUnit::volt;
    DriveLimits limits;
    std::vector<WaveTable> tables;        ///< recorded sine waves, one table a rate
    std::vector<ContinuousModel> models;  ///< one a rate
    std::vector<ShapedWave> shaped;
    double temperature_C = 30.0;  ///< of the lens now, at rest; records are corrected to it
    double drift_D_per_C = 0.033;
    double warming_C_per_square = 0.0;  ///< a drive warms the coil by this times its mean square
};

/// What the plan asks of the lens.
struct WaveWish {
    Dioptre rest, low, high;
    Hertz rate = 60.0_Hz;
    std::vector<Dioptre> levels;  ///< powers at which something is lit, ascending; shaped waves hold them
    /// When slots lie, in sweeps: one about `lowAt`, and so on each `slotLength`. Waves are judged by them and delayed
    /// so that the lowest power falls on `lowAt` and the highest on the middle of a slot, or both beside it by the same
    /// time, never more than a quarter of a slot. Shaped: the middle of the hold of the lowest level falls on `lowAt`.
    double slotLength = 1.0 / 16.0;
    double lowAt = 0.5 / 16.0;
    bool operator==(const WaveWish&) const = default;
};

/// A wave, or the reason why there is none. Never a silent clamp.
struct WaveChoice {
    std::optional<Waveform> wave;
    std::string why;    ///< one sentence when there is no wave
    Dioptre reachable;  ///< the largest `high` for which there is one, all else equal
};
/// Waves are looked for among the entries of the wish's rate that were recorded nearest to the lens's temperature;
/// waves beyond `limits` are no candidates. shaped: the newest wave whose holds lie within 0.02 D of the levels asked
/// for; `reachable` is the wished high then, since learning is what limits it. `low` = `high`: a still lens, whatever
/// was recorded.
WaveChoice chosenWave(const LensCalibration& lens, WaveMode mode, const WaveWish& wish);

}  // namespace ilf
