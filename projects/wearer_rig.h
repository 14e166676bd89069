// Wearer and rig as files of their own.
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/document/rig.h"
#include "core/document/wearer.h"

namespace ilf::projects {

inline constexpr int kWearerVersion = 1;
inline constexpr int kRigVersion = 2;  ///< 1 knew no more of a registration than its homography

/// Numbers out of range, damaged text, another kind of file and newer versions are refused with a sentence; so is a rig
/// whose scanned map is missing or damaged: what it plays on would land elsewhere.
Result<Wearer> readWearer(const std::filesystem::path& path);
Result<Rig> readRig(const std::filesystem::path& path);

/// Written atomically. Keys in an existing file that this version does not know stay. A scanned map goes into a file
/// beside the rig's, under a name that tells its content (NAME-1a2b3c4d5e6f7081.map.exr), before the rig's own file
/// names it; the map it takes the place of is then removed.
Result<void> writeWearer(const std::filesystem::path& path, const Wearer& wearer);
Result<void> writeRig(const std::filesystem::path& path, const Rig& rig);

}  // namespace ilf::projects
