// Which rig the output core was started for, and what plays it.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/document/rig.h"

namespace ilf::app {

/// Where light and lens come from.
enum class Machine {
    simulated,  ///< the simulated devices' process
    emulated,   ///< the drivers of real devices, over cables to the emulated rig's process
    real,       ///< the devices that the rig's file names
};

struct PlayedRig {
    std::string word = "simulated";  ///< as it was given: "simulated", "emulated" or a rig's file
    Rig rig;
    Machine machine = Machine::simulated;
    std::filesystem::path tapes{};  ///< the folder for tapes of what is exchanged with its USB devices; empty: none
};

/// A rig whose file names no devices is simulated.
Result<PlayedRig> playedRig(const std::string& wordOrFile);

/// Its light comes from a window of ours on a display, which needs white below it.
bool lightsThroughDisplay(const PlayedRig& played);

/// Refused while this process does not see the emulated rig of `runtimeDirectory`: it would look for its devices among
/// those of this machine.
Result<void> seesEmulatedRig(const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::app
