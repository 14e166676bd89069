#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>

#include "app/output_core/events.h"
#include "app/output_core/log.h"
#include "app/output_core/player.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/stage_of.h"
#include "app/output_core/studio_link.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

// No start, stop or search of a stage lasts this long: its thread hangs in a driver, and nobody watches over the light.
constexpr std::chrono::seconds kHangs{30};

/// Set for the way out that is meant.
bool g_ends = false;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): atexit takes no argument

/// Libraries end a process that lost its display or its bus, from whatever thread is in them; the link's own clearing
/// up would then wait for threads that never end. The next player must be able to start at once.
void endAtOnce() {
    if (!g_ends) _exit(1);
}

bool isSafe(const devices::Status& status) {
    return status.light == devices::LightMode::steady && status.lens == devices::LensMode::rest && status.lensWell;
}

void endIfHanging(const Player& player) {
    if (player.busyFor() < kHangs) return;
    note(event::kPlayerHangs);
    _exit(1);
}

}  // namespace

int runPlayer(const CoreSetup& setup, const std::string& afterFault) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-player");
    comeFirst();
    startLog("output-core-player");
    const auto lock = devices::FileLock::tryTake(devices::playerLock(setup.runtimeDirectory));
    if (!lock || !*lock) {
        note(event::kPlayerTwice, lock ? "" : lock.error().what);
        return 3;
    }
    auto server = devices::Server::open(devices::coreAddress(setup.runtimeDirectory));
    if (!server) {
        note(event::kNoSocket, server.error().what);
        return 3;
    }
    std::atexit(endAtOnce);  // after the link's context, so that it is asked before that
    // Simulated devices have a process and a clock of their own.
    const bool ownDevices = setup.played.machine != Machine::simulated;
    const std::vector<std::string> limits = ownDevices ? keepTime() : std::vector<std::string>();
    for (const auto& limit : limits)
        note(event::kNotAllowed, limit);
    if (ownDevices) markStage(setup.runtimeDirectory, markedRest(setup.runtimeDirectory));
    const int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    bool safe = false;
    {
        auto stage = stageOf(setup.played, setup.runtimeDirectory);
        note(event::kStage, stage->name());
        Player player(std::move(stage), [wake] { eventfd_write(wake, 1); }, afterFault, limits);
        StudioLink link(*std::move(server), player);
        while (signals.arrived(0).empty()) {
            link.turn(wake, signals.descriptor());
            eventfd_t count = 0;
            eventfd_read(wake, &count);
            endIfHanging(player);
        }
        // Others go on hearing how it is while a stage takes its time to become safe.
        player.end();
        while (!player.ended()) {
            link.turn(wake, wake);
            eventfd_t count = 0;
            eventfd_read(wake, &count);
            endIfHanging(player);
        }
        link.turn(wake, wake);
        safe = isSafe(link.status());
    }
    close(wake);
    g_ends = true;
    if (ownDevices && safe) unmarkStage(setup.runtimeDirectory);
    note(safe ? event::kPlayerStopped : event::kNotSafe);
    return 0;
}

}  // namespace ilf::app
