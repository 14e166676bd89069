#include "devices/link/runtime_directory.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

namespace ilf::devices {
namespace {

constexpr const char* kName = "illuminatedfocus";
constexpr const char* kLongestSocket = "devices.sock";

std::filesystem::path environmentPath(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    return value != nullptr ? std::filesystem::path(value) : std::filesystem::path();
}

/// An open-file-description lock over the whole file: goes with its last descriptor, and can be asked about without
/// taking it, so that asking never makes anybody's start fail.
flock wholeFile() {
    flock lock{};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    return lock;
}

std::string reason() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

}  // namespace

std::filesystem::path runtimeDirectory() {
    if (const auto own = environmentPath("ILF_RUNTIME_DIR"); !own.empty()) return own;
    if (const auto xdg = environmentPath("XDG_RUNTIME_DIR"); !xdg.empty()) return xdg / kName;
    return std::filesystem::path("/tmp") / (std::string(kName) + "-" + std::to_string(getuid()));
}

std::filesystem::path stateDirectory() {
    if (const auto xdg = environmentPath("XDG_STATE_HOME"); !xdg.empty()) return xdg / kName;
    if (const auto home = environmentPath("HOME"); !home.empty()) return home / ".local" / "state" / kName;
    return runtimeDirectory();
}

Result<void> prepareRuntimeDirectory(const std::filesystem::path& directory) {
    const std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
    if ((directory / kLongestSocket).string().size() > longest)
        return fail(Fault::cannotWrite, "The runtime directory \"" + directory.string() +
                                            "\" has too long a path for a socket (at most " + std::to_string(longest) +
                                            " bytes with the socket's name). Set ILF_RUNTIME_DIR to a shorter one.");
    std::error_code error;
    if (directory.has_parent_path()) std::filesystem::create_directories(directory.parent_path(), error);
    if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
        return fail(Fault::cannotWrite, "The runtime directory \"" + directory.string() + "\" cannot be made (" +
                                            reason() + "). Set ILF_RUNTIME_DIR to a directory that can be written.");
    struct stat info{};
    if (lstat(directory.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != geteuid())
        return fail(Fault::cannotWrite, "\"" + directory.string() +
                                            "\" is not a directory of this user, so sockets in it could be anybody's. "
                                            "Remove it or set ILF_RUNTIME_DIR.");
    if ((info.st_mode & 0077U) != 0 && chmod(directory.c_str(), 0700) != 0)
        return fail(Fault::cannotWrite,
                    "\"" + directory.string() + "\" is open to others and cannot be closed (" + reason() + ").");
    return {};
}

std::string coreAddress(const std::filesystem::path& directory) {
    return "ipc://" + (directory / "core.sock").string();
}
std::string devicesAddress(const std::filesystem::path& directory) {
    return "ipc://" + (directory / kLongestSocket).string();
}

std::filesystem::path supervisorLock(const std::filesystem::path& directory) { return directory / "supervisor.lock"; }
std::filesystem::path playerLock(const std::filesystem::path& directory) { return directory / "player.lock"; }
std::filesystem::path devicesLock(const std::filesystem::path& directory) { return directory / "devices.lock"; }
std::filesystem::path startLock(const std::filesystem::path& directory) { return directory / "start.lock"; }

Result<std::optional<FileLock>> FileLock::tryTake(const std::filesystem::path& file) {
    const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0)
        return fail(Fault::cannotWrite, "The lock file \"" + file.string() + "\" cannot be opened (" + reason() + ").");
    FileLock lock(fd);
    auto whole = wholeFile();
    if (fcntl(fd, F_OFD_SETLK, &whole) != 0) return std::optional<FileLock>();
    const std::string pid = std::to_string(getpid()) + "\n";
    if (ftruncate(fd, 0) != 0 || pwrite(fd, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size()))
        return fail(Fault::cannotWrite,
                    "The lock file \"" + file.string() + "\" cannot be written (" + reason() + ").");
    return std::optional<FileLock>(std::move(lock));
}

std::optional<int> FileLock::holder(const std::filesystem::path& file) {
    const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return std::nullopt;
    const FileLock closes(fd);
    auto whole = wholeFile();
    if (fcntl(fd, F_OFD_GETLK, &whole) != 0 || whole.l_type == F_UNLCK) return std::nullopt;
    std::array<char, 32> text{};
    const ssize_t count = pread(fd, text.data(), text.size(), 0);
    int pid = 0;
    if (count <= 0 || std::from_chars(text.data(), text.data() + count, pid).ec != std::errc()) return 0;
    return pid;
}

FileLock::FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
FileLock& FileLock::operator=(FileLock&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
}
FileLock::~FileLock() {
    if (fd_ >= 0) close(fd_);
}

std::int64_t monotonicNs() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace ilf::devices
