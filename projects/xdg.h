// Where settings, data, state and cache live: the XDG folders, with fallbacks.
#pragma once

#include <filesystem>

namespace ilf::projects {

/// Each is .../illuminatedfocus under $XDG_CONFIG_HOME (~/.config), $XDG_DATA_HOME (~/.local/share), $XDG_STATE_HOME
/// (~/.local/state), $XDG_CACHE_HOME (~/.cache). ILF_CONFIG_DIR, ILF_DATA_DIR, ILF_STATE_DIR and ILF_CACHE_DIR, where
/// set, are taken as they are. Relative values are ignored, as the XDG specification asks. Without a home everything
/// lies under /tmp/illuminatedfocus-UID. The folders need not exist yet.
std::filesystem::path configDir();
std::filesystem::path dataDir();
std::filesystem::path stateDir();
std::filesystem::path cacheDir();

}  // namespace ilf::projects
