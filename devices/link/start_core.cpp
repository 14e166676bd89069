#include "devices/link/start_core.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "devices/link/core_link.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {
namespace {

// The core first waits for its devices; a loaded machine takes a while to start three processes, and an emulated rig a
// display server more.
constexpr std::chrono::seconds kStartTime{15};

/// Between fork and exec: only calls that are safe in a child of a threaded process.
[[noreturn]] void becomeDetached(char* const* arguments, char* const* environment, const char* log) {
    setsid();
    const pid_t child = fork();
    if (child != 0) _exit(child < 0 ? 1 : 0);
    const int input = open("/dev/null", O_RDONLY);
    const int output = open(log, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (input >= 0) dup2(input, STDIN_FILENO);
    dup2(output >= 0 ? output : input, STDOUT_FILENO);
    dup2(output >= 0 ? output : input, STDERR_FILENO);
    close_range(3, ~0U, 0);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    execve(arguments[0], arguments, environment);
    _exit(127);
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> out;
    out.reserve(words.size() + 1);
    for (auto& word : words)
        out.push_back(word.data());
    out.push_back(nullptr);
    return out;
}

bool answers(CoreLink& link, std::chrono::steady_clock::time_point deadline) {
    while (std::chrono::steady_clock::now() < deadline) {
        const auto status = link.poll(std::chrono::milliseconds(50));
        if (status && status->connected) return true;
    }
    return false;
}

}  // namespace

std::filesystem::path coreExecutable() {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path("illuminatedfocus-core") : self.parent_path() / "illuminatedfocus-core";
}

Result<void> startDetached(const std::filesystem::path& executable, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log, const std::map<std::string, std::string>& environment) {
    if (access(executable.c_str(), X_OK) != 0)
        return fail(Fault::notFound, "\"" + executable.string() +
                                         "\" is not there or cannot be run; build or install it beside the studio.");
    std::error_code ignored;
    std::filesystem::create_directories(log.parent_path(), ignored);
    std::vector<std::string> words{executable.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> variables = environmentWith(environment);
    const std::vector<char*> argv = pointersTo(words), settings = pointersTo(variables);
    const pid_t child = fork();
    if (child < 0)
        return fail(Fault::device, "The output core cannot be started: the system has no room for a process.");
    if (child == 0) becomeDetached(argv.data(), settings.data(), log.c_str());
    int status = 0;
    waitpid(child, &status, 0);
    return {};
}

std::vector<std::string> environmentWith(const std::map<std::string, std::string>& changed) {
    std::vector<std::string> variables;
    for (char** one = environ; *one != nullptr; ++one) {
        const std::string variable(*one);
        if (!changed.contains(variable.substr(0, variable.find('=')))) variables.push_back(variable);
    }
    for (const auto& [name, value] : changed)
        variables.push_back(name + "=" + value);
    return variables;
}

Result<void> ensureCoreRunning(const std::filesystem::path& executable, const std::filesystem::path& runtimeDirectory,
                               const std::vector<std::string>& arguments) {
    if (const auto ready = prepareRuntimeDirectory(runtimeDirectory); !ready) return ready;
    const auto deadline = std::chrono::steady_clock::now() + kStartTime;
    const auto log = stateDirectory() / "output-core.out";
    CoreLink link(runtimeDirectory);
    // Whoever holds this lock is starting a core; the others wait for it and then find it there.
    std::optional<FileLock> starting;
    while (!starting && !FileLock::holder(supervisorLock(runtimeDirectory))) {
        auto lock = FileLock::tryTake(startLock(runtimeDirectory));
        if (!lock) return tl::unexpected(lock.error());
        starting = *std::move(lock);
        if (std::chrono::steady_clock::now() > deadline)
            return fail(Fault::device,
                        "Another studio has been starting the output core for seconds; see " + log.string() + ".");
        if (!starting) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (!FileLock::holder(supervisorLock(runtimeDirectory))) {
        std::vector<std::string> all{"--runtime-dir", runtimeDirectory.string()};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const auto started = startDetached(executable, all, log);
        if (!started) return started;
    }
    if (answers(link, deadline)) return {};
    return fail(Fault::device, "The output core was started but does not answer; its log is " + log.string() + ".");
}

}  // namespace ilf::devices
