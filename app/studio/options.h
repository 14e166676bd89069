// How the studio is started.
#pragma once

#include <string>

#include "devices/simulated/emulated_lens.h"

namespace ilf::app {

struct StudioOptions {
    std::string file;
    double scale = 0.0;
    std::string size;
    bool resetLayout = false;
    std::string screenshot;
    std::string view;
    std::string frameTimes;  ///< JSON to write at the end: what each frame took
    std::string coreProgram;
    devices::SimulatedLens lens = devices::kUsualLens;  ///< of a core that has to be started
};

/// Opens the window and runs until it is closed; returns the exit code.
int runStudio(const StudioOptions& options);

}  // namespace ilf::app
