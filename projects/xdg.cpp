#include "projects/xdg.h"

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace ilf::projects {

namespace fs = std::filesystem;

namespace {

const char* const kName = "illuminatedfocus";
/// An absolute path from the environment, or an empty one.
fs::path fromEnvironment(const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
}

fs::path home() {
    if (const fs::path set = fromEnvironment("HOME"); !set.empty()) return set;
    const passwd* user = getpwuid(getuid());
    return user != nullptr && user->pw_dir != nullptr && user->pw_dir[0] == '/' ? fs::path(user->pw_dir) : fs::path();
}

fs::path withoutHome() { return fs::path("/tmp") / (std::string(kName) + "-" + std::to_string(getuid())); }

fs::path folder(const char* ours, const char* xdg, const char* underHome) {
    if (const fs::path set = fromEnvironment(ours); !set.empty()) return set;
    if (const fs::path base = fromEnvironment(xdg); !base.empty()) return base / kName;
    const fs::path at = home();
    return at.empty() ? withoutHome() / underHome : at / underHome / kName;
}

}  // namespace

fs::path configDir() { return folder("ILF_CONFIG_DIR", "XDG_CONFIG_HOME", ".config"); }
fs::path dataDir() { return folder("ILF_DATA_DIR", "XDG_DATA_HOME", ".local/share"); }
fs::path stateDir() { return folder("ILF_STATE_DIR", "XDG_STATE_HOME", ".local/state"); }
fs::path cacheDir() { return folder("ILF_CACHE_DIR", "XDG_CACHE_HOME", ".cache"); }

}  // namespace ilf::projects
