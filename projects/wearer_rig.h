// Wearer and rig as files of their own.
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/document/rig.h"
#include "core/document/wearer.h"

namespace ilf::projects {

inline constexpr int kWearerVersion = 1;
inline constexpr int kRigVersion = 1;

/// Numbers out of range, damaged text, another kind of file and newer versions are refused with a sentence.
Result<Wearer> readWearer(const std::filesystem::path& path);
Result<Rig> readRig(const std::filesystem::path& path);

/// Written atomically. Keys in an existing file that this version does not know stay.
Result<void> writeWearer(const std::filesystem::path& path, const Wearer& wearer);
Result<void> writeRig(const std::filesystem::path& path, const Rig& rig);

}  // namespace ilf::projects
