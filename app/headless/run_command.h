// `run`: plans, compiles and streams a project to a simulated core of its own, then reads back what was shown.
#pragma once

#include <string>

#include "app/lens/lens_choice.h"

namespace ilf::app {

struct RunOptions {
    std::string file;
    double seconds = 2.0;
    std::string report;    ///< JSON; empty: none
    std::string pictures;  ///< a directory; empty: none
    LensChoice lens;
    std::string coreProgram;
};

int runCommand(const RunOptions& options);

}  // namespace ilf::app
