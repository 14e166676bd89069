// illuminatedfocus-core: the process that owns lens and projector and plays the last program it was given.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "app/output_core/roles.h"
#include "devices/link/runtime_directory.h"
#include "ilf/version.h"

namespace {

int run(int argc, char** argv) {
    CLI::App options{
        "The output core of IlluminatedFocus: plays programs on lens and projector (simulated), and makes steady white "
        "light, lens at rest, whenever something fails. The studio starts it by itself.",
        "illuminatedfocus-core"};
    std::string directory = ilf::devices::runtimeDirectory().string();
    std::string afterFault, lensWord(ilf::devices::word(ilf::devices::kUsualLens));
    bool leaveDevices = false, stop = false, status = false, player = false, devices = false;
    options.add_option("--runtime-dir", directory, "Where sockets and locks are")->capture_default_str();
    options.add_option("--simulated-lens", lensWord, "The lens that is simulated")
        ->check(CLI::IsMember({"slow", "datasheet", "lively", "clean", "dirty", "ideal"}))
        ->capture_default_str();
    options.add_flag("--leave-devices", leaveDevices, "Leave the simulated devices on when stopping");
    auto* stopFlag = options.add_flag("--stop", stop, "Stop the output core that runs, in safe light");
    auto* statusFlag = options.add_flag("--status", status, "Print what core and devices say, as one line of JSON");
    auto* playerFlag = options.add_flag("--player", player, "Be the player (its supervisor starts it)");
    auto* devicesFlag = options.add_flag("--devices", devices, "Be the simulated lens and projector");
    options.add_option("--after-fault", afterFault, "With --player: why the one before it ended")->needs(playerFlag);
    stopFlag->excludes(statusFlag)->excludes(playerFlag)->excludes(devicesFlag);
    statusFlag->excludes(playerFlag)->excludes(devicesFlag);
    playerFlag->excludes(devicesFlag);
    options.set_version_flag("--version", std::string("illuminatedfocus-core ") + ilf::kVersion);
    try {
        options.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return options.exit(error) == 0 ? 0 : 2;
    }
    if (status) return ilf::app::printStatus(directory);
    if (stop) return ilf::app::stopSupervisor(directory);
    if (const auto ready = ilf::devices::prepareRuntimeDirectory(directory); !ready) {
        std::fprintf(stderr, "%s\n", ready.error().what.c_str());
        return 3;
    }
    if (player) return ilf::app::runPlayer(directory, afterFault);
    const auto lens = *ilf::devices::simulatedLensFromWord(lensWord);
    if (devices) return ilf::app::runDevices(directory, lens);
    return ilf::app::runSupervisor(directory, leaveDevices, lens);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "illuminatedfocus-core: %s\n", error.what());
        return 1;
    }
}
