#include "projects/xdg.h"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

const char* const kName = "illuminatedfocus";
/// sun_path of a Unix socket holds 107 bytes and a 0; the longest name in the folder is shorter than 40.
constexpr std::size_t kLongestRuntimeDir = 107 - 40;

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

fs::path fallbackRuntimeDir() { return fs::path("/tmp") / (std::string(kName) + "-" + std::to_string(getuid())); }

fs::path folder(const char* ours, const char* xdg, const char* underHome) {
    if (const fs::path set = fromEnvironment(ours); !set.empty()) return set;
    if (const fs::path base = fromEnvironment(xdg); !base.empty()) return base / kName;
    const fs::path at = home();
    return at.empty() ? fallbackRuntimeDir() / underHome : at / underHome / kName;
}

}  // namespace

fs::path configDir() { return folder("ILF_CONFIG_DIR", "XDG_CONFIG_HOME", ".config"); }
fs::path dataDir() { return folder("ILF_DATA_DIR", "XDG_DATA_HOME", ".local/share"); }
fs::path stateDir() { return folder("ILF_STATE_DIR", "XDG_STATE_HOME", ".local/state"); }
fs::path cacheDir() { return folder("ILF_CACHE_DIR", "XDG_CACHE_HOME", ".cache"); }

Result<fs::path> runtimeDir() {
    fs::path path = fromEnvironment("ILF_RUNTIME_DIR");
    if (path.empty()) {
        // A runtime folder that is named but not there (su, containers) is as good as none.
        const fs::path base = fromEnvironment("XDG_RUNTIME_DIR");
        std::error_code ignored;
        path = !base.empty() && fs::is_directory(base, ignored) ? base / kName : fallbackRuntimeDir();
    }
    if (path.string().size() > kLongestRuntimeDir) {
        return fail(Fault::outOfRange, "The folder for sockets, " + spoken(path) +
                                           ", has a name that is too long. Set " + "ILF_RUNTIME_DIR to a shorter one.");
    }
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
        return fail(Fault::cannotWrite, "The folder for sockets, " + spoken(path) + ", cannot be created: " +
                                            std::strerror(errno) + ". Set ILF_RUNTIME_DIR to one you may write to.");
    }
    // /tmp is everybody's: a folder or link that somebody else put there is not used.
    struct stat info{};
    if (::lstat(path.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != getuid()) {
        return fail(Fault::unsafe,
                    spoken(path) + " belongs to somebody else. Set ILF_RUNTIME_DIR to a folder of yours.");
    }
    if ((info.st_mode & 0077) != 0) ::chmod(path.c_str(), 0700);
    return path;
}

}  // namespace ilf::projects
