// How processes of the core are started, each as a role of this executable.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/output_core/roles.h"

namespace ilf::app {

using Environment = std::map<std::string, std::string>;

/// As nobody's child, so that it outlives this process; `environment` goes on top of this process's own. Its output is
/// appended to `log` in the state directory.
Result<void> startRole(const CoreSetup& setup, const std::vector<std::string>& role, const std::string& log,
                       const Environment& environment = {});
/// As a child that gets SIGTERM when this process dies; none if there is no room for a process.
std::optional<pid_t> startChild(const CoreSetup& setup, const std::vector<std::string>& role,
                                const Environment& environment = {});

}  // namespace ilf::app
