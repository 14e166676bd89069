// How the studio is started.
#pragma once

#include <optional>
#include <string>

#include "app/lens/rig_choice.h"

namespace ilf::app {

struct StudioOptions {
    std::string file;
    double scale = 0.0;
    std::string size;
    bool resetLayout = false;
    std::string screenshot;
    std::string view;
    std::string frameTimes;      ///< JSON to write at the end: what each frame took
    std::optional<int> oscPort;  ///< poses are heard there; absent: nowhere
    std::string coreProgram;
    std::string emulatedCamera;  ///< words, see devices/emulated_scene/scene_wish.h; empty: as it was
    RigChoice rig;               ///< instead of the document's, and what a core is started with
};

/// Opens the window and runs until it is closed; returns the exit code.
int runStudio(const StudioOptions& options);

}  // namespace ilf::app
