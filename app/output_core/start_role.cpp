#include "app/output_core/start_role.h"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>

#include "devices/link/runtime_directory.h"
#include "devices/link/start_core.h"

namespace ilf::app {
namespace {

std::filesystem::path ownExecutable() { return std::filesystem::read_symlink("/proc/self/exe"); }

std::vector<std::string> wordsFor(const CoreSetup& setup, const std::vector<std::string>& role) {
    std::vector<std::string> words = role;
    for (const std::string& word :
         {std::string("--runtime-dir"), setup.runtimeDirectory.string(), std::string("--rig"), setup.played.word,
          std::string("--simulated-lens"), std::string(devices::word(setup.lens))})
        words.push_back(word);
    if (!setup.played.tapes.empty()) words.insert(words.end(), {"--tapes", setup.played.tapes.string()});
    return words;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> out;
    for (auto& word : words)
        out.push_back(word.data());
    out.push_back(nullptr);
    return out;
}

}  // namespace

Result<void> startRole(const CoreSetup& setup, const std::vector<std::string>& role, const std::string& log,
                       const Environment& environment) {
    return devices::startDetached(ownExecutable(), wordsFor(setup, role), devices::stateDirectory() / log, environment);
}

std::optional<pid_t> startChild(const CoreSetup& setup, const std::vector<std::string>& role,
                                const Environment& environment) {
    const pid_t self = getpid();
    // All before the fork: in a child of a threaded process nothing may be allocated.
    std::vector<std::string> words = wordsFor(setup, role);
    words.insert(words.begin(), ownExecutable().string());
    std::vector<std::string> variables = devices::environmentWith(environment);
    std::vector<char*> arguments = pointers(words), settings = pointers(variables);
    const pid_t child = fork();
    if (child < 0) return std::nullopt;
    if (child > 0) return child;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != self) _exit(1);  // this process died a moment ago
    execve(arguments[0], arguments.data(), settings.data());
    _exit(127);
}

}  // namespace ilf::app
