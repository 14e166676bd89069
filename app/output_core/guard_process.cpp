#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>

#include "app/output_core/events.h"
#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/start_role.h"
#include "devices/link/runtime_directory.h"
#include "devices/link/start_core.h"
#include "devices/video/white_guard.h"

namespace ilf::app {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{100};
// One that starts a core takes its lock within this; a supervisor that lives starts a player sooner.
constexpr int kLooksAlone = 4;
// What makes the stage safe may find devices that are not there; it is tried again, more and more rarely.
constexpr milliseconds kFirstAgain{3000}, kLongestAgain{60000};

/// Nobody holds the stage, and it was left as it was.
bool abandoned(const std::filesystem::path& directory) {
    using devices::FileLock;
    return !FileLock::holder(devices::supervisorLock(directory)) && !FileLock::holder(devices::playerLock(directory)) &&
           stageIsMarked(directory);
}

void watchOver(const CoreSetup& setup, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any wakes;
    const auto sleep = [&](milliseconds time) {
        std::unique_lock lock(mutex);
        wakes.wait_for(lock, stop, time, [] { return false; });
    };
    int alone = 0;
    milliseconds again = kFirstAgain;
    while (!stop.stop_requested()) {
        sleep(kLook);
        if (!abandoned(setup.runtimeDirectory)) {
            alone = 0;
            again = kFirstAgain;
            continue;
        }
        if (++alone < kLooksAlone) continue;
        note(event::kNobodyPlays);
        const auto started = startRole(setup, {"--make-safe"}, "output-core-safe.out");
        if (!started) note(event::kNoProcess, started.error().what);
        sleep(again);
        again = std::min(2 * again, kLongestAgain);
    }
}

}  // namespace

int runGuard(const CoreSetup& setup) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-guard");
    comeFirst();
    startLog("output-core-guard");
    const auto lock = devices::FileLock::tryTake(guardLock(setup.runtimeDirectory));
    if (!lock) note(event::kGuardFailed, lock.error().what);
    if (!lock || !*lock) return 3;  // another one keeps white
    note(event::kGuardStarted);
    const std::jthread watcher([&](const std::stop_token& stop) { watchOver(setup, stop); });
    const Rig& rig = setup.played.rig;
    const auto kept = devices::keepWhite({rig.devices->display, rig.projector}, signals.descriptor(),
                                         [](const std::string& line) { note(event::kGuardSaid, line); });
    if (!kept) note(event::kGuardFailed, kept.error().what);
    note(event::kGuardStopped);
    return kept ? 0 : 3;
}

}  // namespace ilf::app
