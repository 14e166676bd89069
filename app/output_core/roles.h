// The processes that the output core consists of; each function is one of them, from start to exit code.
#pragma once

#include <filesystem>
#include <string>

#include "app/output_core/played_rig.h"
#include "devices/simulated/emulated_lens.h"

namespace ilf::app {

// 0 done, 1 failed, 2 usage, 3 device.

/// What every process of one core is told.
struct CoreSetup {
    std::filesystem::path runtimeDirectory;
    PlayedRig played;
    devices::SimulatedLens lens = devices::kUsualLens;  ///< of simulated and emulated rigs
};

/// Starts what the rig needs (devices' process, white guard, player), watches over it, sees to safe light when the
/// player dies and starts it again.
int runSupervisor(const CoreSetup& setup, bool leaveDevices);
/// Plays on the rig's stage until SIGTERM, or until its supervisor dies. `afterFault`, if not empty, says why the
/// player before this one ended: its first fault.
int runPlayer(const CoreSetup& setup, const std::string& afterFault);
/// The simulated lens and projector, or the emulated rig.
int runDevices(const CoreSetup& setup);
/// White below the player's window, for as long as the display shall not be released. If player and supervisor are
/// gone and left the stage as it was, starts `makeStageSafe`.
int runGuard(const CoreSetup& setup);
/// Steady white light, lens at rest, on a stage that nobody holds; then ends.
int makeStageSafe(const CoreSetup& setup);
/// Asks the supervisor of this directory to stop, and waits until it did. White stays on the projector's display unless
/// that is released.
int stopSupervisor(const std::filesystem::path& runtimeDirectory, bool releaseDisplay);
/// Prints one line of JSON: what core and devices say. 3 if the core does not answer.
int printStatus(const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::app
