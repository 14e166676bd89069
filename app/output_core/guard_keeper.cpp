#include "app/output_core/guard_keeper.h"

#include <csignal>
#include <cstdlib>
#include <fstream>

#include "app/output_core/events.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/wait.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kBetweenStarts{1000}, kGuardStopTime{2000};

std::filesystem::path noteOf(const std::filesystem::path& directory) { return directory / "guard.rig"; }

std::string wordsIn(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

void GuardKeeper::stopGuard(const std::filesystem::path& runtimeDirectory) {
    const auto lock = guardLock(runtimeDirectory);
    const auto pid = devices::FileLock::holder(lock);
    if (!pid || *pid <= 0) return;
    kill(*pid, SIGTERM);
    if (!within(kGuardStopTime, [&] { return !devices::FileLock::holder(lock); })) kill(*pid, SIGKILL);
}

void GuardKeeper::watch(const Environment& environment) {
    if (!lightsThroughDisplay(setup_.played)) return;
    const bool emulated = setup_.played.machine == Machine::emulated;
    if (emulated && environment.empty()) return;  // this machine's display is not meant
    const char* own = std::getenv("DISPLAY");     // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    const auto named = environment.find("DISPLAY");
    const std::string wanted = setup_.played.word + "\n" +
                               (named != environment.end() ? named->second
                                : own != nullptr           ? own
                                                           : "");
    if (devices::FileLock::holder(guardLock(setup_.runtimeDirectory))) {
        if (keeps_.empty()) keeps_ = wordsIn(noteOf(setup_.runtimeDirectory));
        if (keeps_ == wanted) return;
        stop();
    }
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + kBetweenStarts;
    std::ofstream(noteOf(setup_.runtimeDirectory)) << wanted;
    keeps_ = wanted;
    const auto started = startRole(setup_, {"--guard"}, "output-core-guard.out", environment);
    if (!started) note(event::kNoProcess, started.error().what);
}

}  // namespace ilf::app
