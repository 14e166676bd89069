// Starts the output core's process, detached, so that it outlives whoever asked for it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

/// `illuminatedfocus-core` beside the executable that runs now.
std::filesystem::path coreExecutable();

/// Makes sure that an output core answers in `runtimeDirectory`: finds the one that runs, or starts `executable`. Two
/// studios that ask at the same time start one. Returns within about fifteen seconds, at once where
/// a core answers. A core that is started gets `arguments` beside its directory.
Result<void> ensureCoreRunning(const std::filesystem::path& executable, const std::filesystem::path& runtimeDirectory,
                               const std::vector<std::string>& arguments = {});

/// Runs `executable` in a session of its own, as nobody's child, with its output appended to `log`; `environment` goes
/// on top of this process's own.
Result<void> startDetached(const std::filesystem::path& executable, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log,
                           const std::map<std::string, std::string>& environment = {});

/// This process's variables, "NAME=VALUE", with `changed` in place of those of the same name or beside them.
std::vector<std::string> environmentWith(const std::map<std::string, std::string>& changed);

}  // namespace ilf::devices
