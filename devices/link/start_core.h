// Starts the output core's process, detached, so that it outlives whoever asked for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

/// `illuminatedfocus-core` beside the executable that runs now.
std::filesystem::path coreExecutable();

/// Makes sure that an output core answers in `runtimeDirectory`: finds the one that runs, or starts `executable`. Two
/// studios that ask at the same time start one. Returns within about five seconds. A core that is started gets
/// `arguments` beside its directory.
Result<void> ensureCoreRunning(const std::filesystem::path& executable, const std::filesystem::path& runtimeDirectory,
                               const std::vector<std::string>& arguments = {});

/// Runs `executable` in a session of its own, as nobody's child, with its output appended to `log`.
Result<void> startDetached(const std::filesystem::path& executable, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log);

}  // namespace ilf::devices
