// The processes that the output core consists of; each function is one of them, from start to exit code.
#pragma once

#include <filesystem>
#include <string>

#include "devices/simulated/emulated_lens.h"

namespace ilf::app {

// 0 done, 1 failed, 2 usage, 3 device.

/// Starts devices (with this lens) and player, watches the player, makes safe light when it dies and starts it again.
int runSupervisor(const std::filesystem::path& runtimeDirectory, bool leaveDevices, devices::SimulatedLens lens);
/// Plays on the devices until SIGTERM, or until its supervisor dies. `afterFault`, if not empty, says why the player
/// before this one ended: its first fault.
int runPlayer(const std::filesystem::path& runtimeDirectory, const std::string& afterFault);
/// The simulated lens and projector.
int runDevices(const std::filesystem::path& runtimeDirectory, devices::SimulatedLens lens);
/// Asks the supervisor of this directory to stop, and waits until it did.
int stopSupervisor(const std::filesystem::path& runtimeDirectory);
/// Prints one line of JSON: what core and devices say. 3 if the core does not answer.
int printStatus(const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::app
