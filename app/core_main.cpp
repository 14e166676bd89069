// illuminatedfocus-core: the process that owns lens and projector and plays the last program it was given.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "app/output_core/roles.h"
#include "devices/link/rig_mishap.h"
#include "devices/link/runtime_directory.h"
#include "devices/simulated/device_client.h"
#include "ilf/version.h"

namespace {

int refused(const ilf::Error& error, int code) {
    std::fprintf(stderr, "%s\n", error.what.c_str());
    return code;
}

int befall(const std::string& directory, const std::string& text) {
    const auto mishap = ilf::devices::mishapFrom(text);
    if (!mishap) return refused(mishap.error(), 2);
    // A display takes a while to be plugged in.
    const auto done = ilf::devices::DeviceClient(directory, std::chrono::milliseconds(10'000)).mishap(*mishap);
    return done ? 0 : refused(done.error(), 3);
}

int run(int argc, char** argv) {
    CLI::App options{
        "The output core of IlluminatedFocus: plays programs on lens and projector, and makes steady white light, lens "
        "at rest, whenever something fails. The studio starts it by itself.",
        "illuminatedfocus-core"};
    std::string directory = ilf::devices::runtimeDirectory().string(), rig = "simulated";
    std::string afterFault, lensWord(ilf::devices::word(ilf::devices::kUsualLens));
    bool leaveDevices = false, stop = false, releaseDisplay = false, status = false;
    bool player = false, devices = false, guard = false, makeSafe = false;
    options.add_option("--runtime-dir", directory, "Where sockets and locks are")->capture_default_str();
    options
        .add_option("--rig", rig,
                    "What is played on: simulated, emulated (the drivers of real devices over emulated cables), or a "
                    "rig's file; one that names no devices is simulated")
        ->capture_default_str();
    options.add_option("--simulated-lens", lensWord, "The lens of a simulated or emulated rig")
        ->check(CLI::IsMember({"slow", "datasheet", "lively", "clean", "dirty", "ideal"}))
        ->capture_default_str();
    std::string tapes;
    options
        .add_option(
            "--tapes", tapes,
            "A folder for tapes: every exchange with each USB device (but the samples it streams), as text, some "
            "10 MB an hour")
        ->check(CLI::ExistingDirectory);
    options.add_flag("--leave-devices", leaveDevices, "Leave simulated or emulated devices on when stopping");
    auto* stopFlag = options.add_flag("--stop", stop, "Stop the output core that runs, in safe light");
    options.add_flag("--release-display", releaseDisplay, "With --stop: the projector's display, too, is given back")
        ->needs(stopFlag);
    auto* statusFlag = options.add_flag("--status", status, "Print what core and devices say, as one line of JSON");
    std::string mishap;
    auto* mishapOption = options.add_option(
        "--mishap", mishap,
        "Let something go wrong in the emulated rig that plays: DEVICE:KIND, such as projector:unplug, display:unplug, "
        "lenses:underrun or projector:wrong-mode; DEVICE:plug puts a cable back, DEVICE:none ends the rest");
    auto* playerFlag = options.add_flag("--player", player, "Be the player (its supervisor starts it)");
    auto* devicesFlag = options.add_flag("--devices", devices, "Be the simulated or emulated devices");
    auto* guardFlag = options.add_flag("--guard", guard, "Be the white below the player's window");
    auto* safeFlag = options.add_flag("--make-safe", makeSafe, "Make a stage safe that nobody holds, and end");
    options.add_option("--after-fault", afterFault, "With --player: why the one before it ended")->needs(playerFlag);
    CLI::Option* roles[] = {stopFlag, statusFlag, mishapOption, playerFlag, devicesFlag, guardFlag, safeFlag};
    for (auto* one : roles)
        for (auto* other : roles)
            if (one != other) one->excludes(other);
    options.set_version_flag("--version", std::string("illuminatedfocus-core ") + ilf::kVersion);
    try {
        options.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return options.exit(error) == 0 ? 0 : 2;
    }
    if (status) return ilf::app::printStatus(directory);
    if (stop) return ilf::app::stopSupervisor(directory, releaseDisplay);
    if (!mishap.empty()) return befall(directory, mishap);
    auto played = ilf::app::playedRig(rig);
    if (!played) return refused(played.error(), 2);
    if (played->machine == ilf::app::Machine::emulated && lensWord == "ideal")
        return refused({ilf::Fault::unsupported, "The emulated rig drives a lens by its coil, which the ideal one does "
                                                 "not have: choose slow, datasheet, lively, clean or dirty."},
                       2);
    if (!tapes.empty()) played->tapes = std::filesystem::absolute(tapes);
    if (guard && !ilf::app::lightsThroughDisplay(*played))
        return refused({ilf::Fault::unsupported, "This rig has no display to keep white."}, 2);
    if (const auto ready = ilf::devices::prepareRuntimeDirectory(directory); !ready) return refused(ready.error(), 3);
    const ilf::app::CoreSetup setup{directory, *std::move(played), *ilf::devices::simulatedLensFromWord(lensWord)};
    if (player) return ilf::app::runPlayer(setup, afterFault);
    if (devices) return ilf::app::runDevices(setup);
    if (guard) return ilf::app::runGuard(setup);
    if (makeSafe) return ilf::app::makeStageSafe(setup);
    return ilf::app::runSupervisor(setup, leaveDevices);
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
