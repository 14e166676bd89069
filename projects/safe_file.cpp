#include "projects/safe_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

namespace ilf::projects {
namespace {

/// Steps left until the failing one; 0: no failure is wanted.
thread_local int failingStep = 0;
thread_local int stepsTaken = 0;
thread_local Failing failingHow = Failing::fullDisk;

/// Every change of the disk passes here first.
bool stepAllowed() {
    if (failingStep == 0) return true;
    ++stepsTaken;
    const bool fails = failingHow == Failing::fullDisk ? stepsTaken == failingStep : stepsTaken >= failingStep;
    if (fails) errno = ENOSPC;
    return !fails;
}

tl::unexpected<Error> cannotWrite(const fs::path& path, int error) {
    std::string help;
    if (error == ENOSPC || error == EDQUOT) help = " Make room on that disk, or save elsewhere.";
    if (error == EACCES || error == EPERM || error == EROFS) help = " Choose a folder you may write to.";
    return fail(Fault::cannotWrite, spoken(path) + " cannot be written: " + std::strerror(error) + "." + help);
}

/// A file descriptor that is closed at the end of the scope.
struct Descriptor {
    int fd = -1;
    explicit Descriptor(int descriptor) : fd(descriptor) {}
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
};

bool writeAll(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

Result<void> linkFile(const fs::path& from, const fs::path& to) {
    if (!stepAllowed()) return cannotWrite(to, errno);
    if (::link(from.c_str(), to.c_str()) == 0) return {};
    std::error_code error;
    fs::copy_file(from, to, error);
    if (error) return cannotWrite(to, error.value());
    const Descriptor file(::open(to.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.fd < 0 || ::fsync(file.fd) != 0) return cannotWrite(to, errno);
    return {};
}

}  // namespace

FailAt::FailAt(int step, Failing how) {
    assert(step > 0 && failingStep == 0);
    failingStep = step;
    failingHow = how;
    stepsTaken = 0;
}
FailAt::~FailAt() { failingStep = 0; }
bool FailAt::reached() const { return stepsTaken >= failingStep; }

std::string spoken(const fs::path& path) {
    std::string quoted(1, '"');
    quoted.append(path.string()).push_back('"');
    return quoted;
}

Result<std::string> readWhole(const fs::path& path, std::size_t maxBytes) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.fd < 0) {
        if (errno == ENOENT || errno == ENOTDIR) {
            return fail(Fault::notFound, spoken(path) + " does not exist. Check the name, or where it was moved to.");
        }
        return fail(Fault::badFile, spoken(path) + " cannot be opened: " + std::strerror(errno) + ".");
    }
    struct stat info{};
    if (::fstat(file.fd, &info) != 0) {
        return fail(Fault::badFile, spoken(path) + " cannot be read: " + std::strerror(errno) + ".");
    }
    if (S_ISDIR(info.st_mode)) return fail(Fault::badFile, spoken(path) + " is a folder; choose a file inside it.");
    if (!S_ISREG(info.st_mode)) return fail(Fault::badFile, spoken(path) + " is not a file but a device or a pipe.");
    const auto size = static_cast<std::size_t>(info.st_size);
    if (size > maxBytes) {
        return fail(Fault::badFile, spoken(path) + " has " + std::to_string(size >> 20) + " MB; at most " +
                                        std::to_string(maxBytes >> 20) + " MB are read.");
    }
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n = ::read(file.fd, bytes.data() + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(Fault::badFile, spoken(path) + " cannot be read: " + std::strerror(errno) + ".");
        if (n == 0) break;  // it shrank while being read
        done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return bytes;
}

Result<void> writeNew(const fs::path& path, std::string_view bytes) {
    if (!stepAllowed()) return cannotWrite(path, errno);
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.fd < 0) return cannotWrite(path, errno);
    if (!stepAllowed() || !writeAll(file.fd, bytes)) return cannotWrite(path, errno);
    if (!stepAllowed() || ::fsync(file.fd) != 0) return cannotWrite(path, errno);
    return {};
}

Result<void> writeAtomically(const fs::path& path, std::string_view bytes) {
    std::error_code ignored;
    const fs::path target = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
    if (fs::is_directory(target, ignored)) return fail(Fault::cannotWrite, spoken(target) + " is a folder.");
    const fs::path fresh = siblingOf(target, "new");
    auto written = writeNew(fresh, bytes).and_then([&]() -> Result<void> {
        if (!stepAllowed() || ::rename(fresh.c_str(), target.c_str()) != 0) return cannotWrite(target, errno);
        return {};
    });
    if (!written) {
        removeQuietly(fresh);
        return written;
    }
    return syncFolder(target.parent_path());
}

Result<void> linkTree(const fs::path& from, const fs::path& to) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(from, error);
    if (error) return cannotWrite(from, error.value());
    if (fs::is_symlink(status)) {
        if (!stepAllowed()) return cannotWrite(to, errno);
        fs::copy_symlink(from, to, error);
        return error ? Result<void>(cannotWrite(to, error.value())) : Result<void>();
    }
    if (fs::is_regular_file(status)) return linkFile(from, to);
    if (!fs::is_directory(status)) return {};  // sockets and pipes are not content
    if (!stepAllowed() || ::mkdir(to.c_str(), 0777) != 0) return cannotWrite(to, errno);
    fs::directory_iterator entries(from, error);
    if (error) return cannotWrite(from, error.value());
    for (const auto& entry : entries) {
        if (auto linked = linkTree(entry.path(), to / entry.path().filename()); !linked) return linked;
    }
    return syncFolder(to);
}

Result<void> makeFolders(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) return {};
    if (!stepAllowed()) return cannotWrite(path, errno);
    fs::create_directories(path, error);
    if (error) return cannotWrite(path, error.value());
    return {};
}

Result<void> syncFolder(const fs::path& path) {
    const fs::path folder = path.empty() ? fs::path(".") : path;
    if (!stepAllowed()) return cannotWrite(folder, errno);
    const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (file.fd < 0) return cannotWrite(folder, errno);
    // Some network file systems cannot sync a folder and say so with EINVAL; their rename is durable by itself.
    if (::fsync(file.fd) != 0 && errno != EINVAL) return cannotWrite(folder, errno);
    return {};
}

Result<fs::path> putInPlace(const fs::path& fresh, const fs::path& target) {
    if (!stepAllowed()) return cannotWrite(target, errno);
    std::error_code ignored;
    if (!fs::is_directory(fs::symlink_status(target, ignored))) {
        if (::rename(fresh.c_str(), target.c_str()) != 0) return cannotWrite(target, errno);
        return fs::path();
    }
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return fresh;
    if (errno != EINVAL && errno != ENOSYS) return cannotWrite(target, errno);
    // File systems that cannot exchange two names (FAT, some network ones): two renames, with the old tree a sibling
    // in between.
    const fs::path old = siblingOf(target, "old");
    if (::rename(target.c_str(), old.c_str()) != 0) return cannotWrite(target, errno);
    if (::rename(fresh.c_str(), target.c_str()) != 0) {
        const int error = errno;
        if (::rename(old.c_str(), target.c_str()) != 0) {
            return fail(Fault::cannotWrite, spoken(target) + " could not be put in place (" + std::strerror(error) +
                                                "). Its previous state is " + spoken(old) + ".");
        }
        return cannotWrite(target, error);
    }
    return old;
}

void removeQuietly(const fs::path& path) {
    if (path.empty() || !stepAllowed()) return;
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

fs::path siblingOf(const fs::path& path, std::string_view purpose) {
    static std::atomic<unsigned> counter{0};
    std::string base(1, '.');
    base.append(path.filename().string()).append(".").append(purpose).append("-");
    std::error_code ignored;
    for (;;) {
        const fs::path name =
            path.parent_path() / (base + std::to_string(::getpid()) + "-" + std::to_string(++counter));
        if (!fs::exists(fs::symlink_status(name, ignored))) return name;
    }
}

}  // namespace ilf::projects
