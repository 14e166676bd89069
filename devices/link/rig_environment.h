// What a program needs in its environment to see an emulated rig's bus and display instead of this machine's.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/base/result.h"

namespace ilf::devices {

/// Variables by name: UMOCKDEV_DIR, DISPLAY and LD_PRELOAD.
using RigEnvironment = std::map<std::string, std::string>;

/// "emulated-rig.env" in the runtime directory: one line NAME=VALUE for each variable. There while the rig is ready.
std::filesystem::path rigEnvironmentFile(const std::filesystem::path& runtimeDirectory);
/// Refused (`notFound`) while no emulated rig is ready in this directory, and where the file is not one of ours.
Result<RigEnvironment> rigEnvironment(const std::filesystem::path& runtimeDirectory);
/// Written whole or not at all. Values must not hold line breaks.
Result<void> saveRigEnvironment(const std::filesystem::path& runtimeDirectory, const RigEnvironment& environment);
void removeRigEnvironment(const std::filesystem::path& runtimeDirectory) noexcept;

}  // namespace ilf::devices
