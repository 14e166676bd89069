#include <spdlog/spdlog.h>
#include <sys/prctl.h>

#include <csignal>

#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "devices/simulated/device_server.h"

namespace ilf::app {

int runDevices(const std::filesystem::path& runtimeDirectory, devices::SimulatedLens lens) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-devices");  // its own name: whoever kills the core by name leaves the machine running
    comeFirst();
    startLog("simulated-devices");
    const auto served = devices::serveDevices(runtimeDirectory, lens, signals.descriptor(),
                                              [](const std::string& line) { spdlog::info("{}", line); });
    if (served) return 0;
    spdlog::error("{}", served.error().what);
    return 3;
}

}  // namespace ilf::app
