// What was measured, as it is kept: a wave database, and the rig with its own numbers.
#pragma once

#include <string>

#include "app/measure/measure_place.h"
#include "projects/wave_database.h"

namespace ilf::app {

/// Waves and delay, with the conditions they were measured under and what they come from.
projects::WaveFile measuredWaves(const devices::MeasuredRig& measured, const MeasureOrder& order, bool simulated);

/// The rig with static powers and delay as measured, planning with the waves of `file` (made absolute).
Rig withMeasured(Rig rig, const devices::MeasuredRig& measured, Eye eye, const std::string& file, bool simulated);

}  // namespace ilf::app
