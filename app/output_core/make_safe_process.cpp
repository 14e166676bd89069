#include <sys/prctl.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "app/output_core/events.h"
#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "app/output_core/stage_mark.h"
#include "app/output_core/stage_of.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

using std::chrono::milliseconds;

// A stage looks for lost devices once a second.
constexpr std::chrono::seconds kTry{10};

bool safe(const devices::StageReport& report) {
    return report.well && report.light == devices::LightMode::steady && report.lens == devices::LensMode::rest;
}

}  // namespace

int makeStageSafe(const CoreSetup& setup) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-safe");
    comeFirst();
    startLog("output-core-safe");
    const auto lock = devices::FileLock::tryTake(devices::playerLock(setup.runtimeDirectory));
    if (!lock || !*lock) return 0;  // a player has the stage: it is safe, or played
    const auto stage = stageOf(setup.played, setup.runtimeDirectory);
    const auto deadline = std::chrono::steady_clock::now() + kTry;
    stage->safeLight();
    std::string why;
    while (!safe(stage->report()) && std::chrono::steady_clock::now() < deadline) {
        if (!signals.arrived(200).empty()) break;
        const auto well = stage->heartbeat();
        if (well) continue;
        why = well.error().what;
        stage->safeLight();
    }
    const auto report = stage->report();
    if (!safe(report)) {
        note(event::kNotSafe, report.projectorLine + "; " + report.lensLine + (why.empty() ? "" : ": " + why));
        return 3;
    }
    unmarkStage(setup.runtimeDirectory);
    note(event::kMadeSafe, report.projectorLine + "; " + report.lensLine);
    return 0;
}

}  // namespace ilf::app
