// Where settings, data, state, cache and sockets live: the XDG folders, with fallbacks.
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace ilf::projects {

/// Each is .../illuminatedfocus under $XDG_CONFIG_HOME (~/.config), $XDG_DATA_HOME (~/.local/share), $XDG_STATE_HOME
/// (~/.local/state), $XDG_CACHE_HOME (~/.cache). ILF_CONFIG_DIR, ILF_DATA_DIR, ILF_STATE_DIR and ILF_CACHE_DIR, where
/// set, are taken as they are. Relative values are ignored, as the XDG specification asks. Without a home everything
/// lies under the runtime folder. The folders need not exist yet.
std::filesystem::path configDir();
std::filesystem::path dataDir();
std::filesystem::path stateDir();
std::filesystem::path cacheDir();

/// A folder of this user's own (mode 0700) for sockets and locks, created here: $ILF_RUNTIME_DIR,
/// $XDG_RUNTIME_DIR/illuminatedfocus, or /tmp/illuminatedfocus-UID when that is empty. Refused when somebody else owns
/// it, or when it is so long that a socket's path (107 bytes) would not fit.
Result<std::filesystem::path> runtimeDir();

}  // namespace ilf::projects
