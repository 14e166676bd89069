// `scan`: shows Gray-code patterns on a rig, takes pictures of them and writes the map they decode to.
#pragma once

#include <string>

#include "app/lens/rig_choice.h"

namespace ilf::app {

struct ScanOptions {
    RigChoice rig;
    std::string camera;   ///< id; empty: the emulated one on rigs that nobody owns, else the first that is plugged in
    std::string out;      ///< map to write
    std::string keep;     ///< folder for the pictures; empty: not kept
    std::string quality;  ///< picture of what was decoded where; empty: none
    int sweeps = 0;       ///< of exposure; 0: found
    bool anyway = false;  ///< also where the ambient check says no
    bool json = false;
    std::string coreProgram;
};

/// On a core of its own. Success only once the map was checked on stripes shown anew, written and read back.
int scanCommand(const ScanOptions& options);

}  // namespace ilf::app
