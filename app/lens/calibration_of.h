// What the planner gets to know of a lens: from a wave database, or recorded on the lens emulator at start.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "app/lens/record_lens.h"
#include "core/lens/calibration.h"
#include "devices/simulated/lens_emulator.h"
#include "projects/wave_database.h"

namespace ilf::app {

using Calibration = std::shared_ptr<const LensCalibration>;

/// Tables and models, one a rate; a rate with too few waves for a model has a table only. Drives beyond the largest
/// recorded (peak and rms) are never asked of a lens: the records are the proof that it bears them.
Result<Calibration> calibrationFrom(const projects::WaveFile& waves);

/// Plays sine drives on a lens emulator as one would on a lens, and fits what was recorded: about 0.1 s on one core the
/// first time, kept for each preset, rate and rest power (to a dioptre). May be called from any thread.
Result<Calibration> simulatedCalibration(devices::LensPreset preset, Hertz rate, Dioptre rest = {});

/// With the paper's 2485 waves, for the ways of choosing that take recorded waves alone. Recorded on the emulator the
/// first time (seconds on two cores) and kept as a wave database in the cache folder; a file there that cannot be read
/// is made anew. May be called from any thread.
Result<Calibration> simulatedTable(devices::LensPreset preset, Hertz rate);

/// Like simulatedCalibration with one more shaped wave that holds the lens at `levels` for `duty` of the sweep each,
/// learnt on the emulator.
Result<Calibration> withShapedWave(const Calibration& calibration, devices::LensPreset preset,
                                   std::span<const Dioptre> levels, double duty, int harmonics, Hertz rate);

/// The emulator a file's waves were recorded on; none for a real lens.
std::optional<LensBench> benchOf(const projects::RecordedLens& lens);
projects::RecordedLens lensOf(const LensBench& bench);
/// A database of that lens, recorded now, without waves.
projects::WaveFile emptyFile(const LensBench& bench);

/// A wave that holds the lens of `bench` at `levels` for `duty` of the sweep each, learnt on it.
Result<ShapedWave> learntOn(const LensBench& bench, std::span<const Dioptre> levels, double duty, int harmonics,
                            Hertz rate);

}  // namespace ilf::app
