#include <sys/prctl.h>

#include <csignal>
#include <cstdio>

#include "app/output_core/events.h"
#include "app/output_core/log.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "devices/emulated_rig/emulated_rig.h"
#include "devices/simulated/device_server.h"

namespace ilf::app {

int runDevices(const CoreSetup& setup) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-devices");  // its own name: whoever kills the core by name leaves the machine running
    comeFirst();
    const bool emulated = setup.played.machine == Machine::emulated;
    startLog(emulated ? "emulated-rig" : "simulated-devices");
    const auto said = [](const std::string& line) { note(event::kDevicesSaid, line); };
    const auto served = emulated
                            ? devices::serveEmulatedRig(setup.runtimeDirectory,
                                                        setup.lens.preset.value_or(devices::LensPreset::datasheet),
                                                        signals.descriptor(), said)
                            : devices::serveDevices(setup.runtimeDirectory, setup.lens, signals.descriptor(), said);
    if (served) return 0;
    note(event::kDevicesFailed, served.error().what);
    std::fprintf(stderr, "%s\n", served.error().what.c_str());
    return 3;
}

}  // namespace ilf::app
