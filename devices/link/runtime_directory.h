// Where processes of one user meet: sockets, locks and logs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace ilf::devices {

/// $ILF_RUNTIME_DIR, else $XDG_RUNTIME_DIR/illuminatedfocus, else /tmp/illuminatedfocus-UID. Names it, makes nothing.
std::filesystem::path runtimeDirectory();
/// $XDG_STATE_HOME/illuminatedfocus, else ~/.local/state/illuminatedfocus, else the runtime directory: for logs.
std::filesystem::path stateDirectory();
/// Makes the directory with mode 0700. Refuses one that belongs to somebody else, or whose path is too long for a
/// Unix socket in it (108 bytes, unix(7)).
Result<void> prepareRuntimeDirectory(const std::filesystem::path& directory);

/// ZeroMQ addresses of the two servers.
std::string coreAddress(const std::filesystem::path& runtimeDirectory);
std::string devicesAddress(const std::filesystem::path& runtimeDirectory);

/// An exclusive lock on a file, given back when the object or the process goes, however it goes. The file holds the
/// process id of its owner.
class FileLock {
public:
    /// Nothing if another process holds it; refuses if the file cannot be made.
    static Result<std::optional<FileLock>> tryTake(const std::filesystem::path& file);
    /// The process id written by the holder, or nothing if nobody holds it.
    static std::optional<int> holder(const std::filesystem::path& file);

    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    ~FileLock();

private:
    explicit FileLock(int fd) : fd_(fd) {}
    int fd_ = -1;
};

std::filesystem::path supervisorLock(const std::filesystem::path& runtimeDirectory);
std::filesystem::path playerLock(const std::filesystem::path& runtimeDirectory);
std::filesystem::path devicesLock(const std::filesystem::path& runtimeDirectory);
std::filesystem::path startLock(const std::filesystem::path& runtimeDirectory);

/// CLOCK_MONOTONIC in nanoseconds: the one clock that all processes of a machine share.
std::int64_t monotonicNs();

}  // namespace ilf::devices
