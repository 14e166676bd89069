// `run`: plans, compiles and streams a project to a core of its own, then reads back what was shown.
#pragma once

#include <string>
#include <vector>

#include "app/lens/rig_choice.h"

namespace ilf::app {

struct RunOptions {
    std::string file;
    double seconds = 2.0;
    std::string report;    ///< JSON; empty: none
    std::string pictures;  ///< a directory; empty: none
    RigChoice rig;
    std::vector<std::string> mishaps;  ///< DEVICE:KIND[:AFTER[:TIMES[:AMOUNT]]], once the program is on show
    std::string coreProgram;
};

/// kDevice where light received is not the light the plan states, or after a fault.
int runCommand(const RunOptions& options);

}  // namespace ilf::app
