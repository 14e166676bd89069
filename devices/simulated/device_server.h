// The simulated lens and projector as a process: answers orders until asked to stop.
#pragma once

#include <filesystem>
#include <functional>

#include "core/base/result.h"
#include "devices/simulated/emulated_lens.h"

namespace ilf::devices {

/// Serves until `stopDescriptor` (for example a signalfd) can be read. `said` gets one line for each thing worth a log.
/// Ends with steady light, as all ends do. Refuses if other devices run in this directory already.
Result<void> serveDevices(const std::filesystem::path& runtimeDirectory, SimulatedLens lens, int stopDescriptor,
                          const std::function<void(const std::string&)>& said);

}  // namespace ilf::devices
