#include "app/headless/doctor_command.h"

#include <unistd.h>

#include <iostream>

#include "app/exit_code.h"
#include "app/headless/doctor_report.h"
#include "app/headless/prepare.h"
#include "devices/link/runtime_directory.h"
#include "devices/survey/survey.h"
#include "devices/survey/udev_rules.h"

namespace ilf::app {
namespace {

/// The processes of the output core that runs, if one does.
std::vector<int> coreProcesses() {
    std::vector<int> processes;
    const auto directory = devices::runtimeDirectory();
    for (const auto& lock : {devices::playerLock(directory), devices::supervisorLock(directory)})
        if (const auto process = devices::FileLock::holder(lock)) processes.push_back(*process);
    return processes;
}

int installRulesCommand(const devices::SystemPlaces& places) {
    const bool mayWrite = geteuid() == 0 || places.root != "/";
    const auto installed = devices::installedRules(places);
    if (!mayWrite && installed.same) {
        std::cout << "The rules in " << installed.file.string() << " are already those of this version.\n";
        return kDone;
    }
    if (!mayWrite) {
        std::cout << "Only root may install the USB rules; nothing was changed. As root:\n\n" << devices::rulesByHand();
        return kFailed;
    }
    const auto done = devices::installRules(places);
    if (!done) return refused("doctor", done.error());
    for (const std::string& sentence : *done)
        std::cout << sentence << '\n';
    return kDone;
}

}  // namespace

int doctorCommand(const DoctorOptions& options) {
    devices::SurveyOptions how;
    how.places.root = options.root;
    if (options.installRules) return installRulesCommand(how.places);
    how.core = coreProcesses();
    if (options.ask) how.ask = devices::Ask::evenWithCore;
    auto attached = devices::survey(how);
    if (!attached) return refused("doctor", attached.error());
    const DoctorReport report{*std::move(attached), devices::machineChecks(how.places), how.core};
    (options.json ? printDoctorJson : printDoctor)(std::cout, report);
    return exitCode(report);
}

int listDevicesCommand() {
    devices::SurveyOptions how;
    how.ask = devices::Ask::nothing;
    how.core = coreProcesses();
    const auto attached = devices::survey(how);
    if (!attached) return refused("--list-devices", attached.error());
    printDeviceList(std::cout, *attached);
    return exitCode(DoctorReport{*attached, {}, how.core});
}

}  // namespace ilf::app
