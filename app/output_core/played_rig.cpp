#include "app/output_core/played_rig.h"

#include <cstdlib>

#include "app/rigs.h"
#include "devices/link/rig_environment.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {

Result<PlayedRig> playedRig(const std::string& wordOrFile) {
    auto rig = rigFrom(wordOrFile);
    if (!rig) return tl::unexpected(rig.error());
    const Machine machine = isEmulatedRig(wordOrFile) ? Machine::emulated
                            : rig->devices            ? Machine::real
                                                      : Machine::simulated;
    // Processes of the core are started from elsewhere.
    std::error_code ignored;
    const bool isWord = isEmulatedRig(wordOrFile) || wordOrFile == kSimulatedRig;
    std::string word = isWord ? wordOrFile : std::filesystem::absolute(wordOrFile, ignored).string();
    return PlayedRig{std::move(word), *std::move(rig), machine};
}

bool lightsThroughDisplay(const PlayedRig& played) {
    if (played.machine == Machine::simulated) return false;
    return played.rig.devices->rehearsal ||
           (played.rig.devices->projectorPlugin.empty() && played.rig.kind == ProjectorKind::lightCrafter4500);
}

Result<void> seesEmulatedRig(const std::filesystem::path& runtimeDirectory) {
    const auto wanted = devices::rigEnvironment(runtimeDirectory);
    // One that was killed leaves its words behind.
    if (!wanted || !devices::FileLock::holder(devices::devicesLock(runtimeDirectory)))
        return fail(Fault::notFound,
                    "The emulated rig is not there: it is being started, or lacks Xvfb or libumockdev-preload.so.0 "
                    "(packages xvfb and umockdev); what it says stands in " +
                        (devices::stateDirectory() / "emulated-rig.log").string() + ".");
    for (const auto& [name, value] : *wanted) {
        const char* own = std::getenv(name.c_str());  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
        if (own == nullptr || value != own)
            return fail(Fault::device, "The emulated rig was started anew, and this process does not see it; stop "
                                       "the output core and start it again.");
    }
    return {};
}

}  // namespace ilf::app
