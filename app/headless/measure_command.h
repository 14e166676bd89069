// `measure`: what a rig is measured with: a projector's delay from a recording, and a lens step by step.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/rigs.h"

namespace ilf::app {

struct MeasureDelayOptions {
    std::string recording;     ///< .csv, .wav or .flac
    double frames_Hz = 0.0;    ///< of the pattern, where the recording has no trigger; 0: what it keeps
    double shortest_ms = 3.0;  ///< edges nearer than this are not told apart
    bool json = false;
};
/// With a trigger the delay, without one how evenly edges come. Exit code 3 where the recording tells none.
int measureDelayCommand(const MeasureDelayOptions& options);

struct MeasureRigOptions {
    std::string rig = kEmulatedRig;  ///< or a rig's file
    std::string eye = "left";
    std::string known;                    ///< CSV: milliamperes, dioptres
    std::optional<double> temperature_C;  ///< of the lens
    double rate_Hz = 60.0;
    std::size_t waves = 40;
    std::vector<double> shape_D;  ///< levels of a wave to be learnt as well; empty: none
    bool withoutProjector = false;
    bool yes = false;            ///< everything is connected: no questions
    bool replace = false;        ///< files that are there may be overwritten
    std::string model, serial;   ///< of the lens
    std::string lens, savedRig;  ///< files to write
};
/// Step by step; nothing is written unless every step was good. Emulated: on an emulated bench, simulated.
int measureRigCommand(const MeasureRigOptions& options);

}  // namespace ilf::app
