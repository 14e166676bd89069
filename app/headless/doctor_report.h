// What a doctor found, as a page for an operator or as JSON for scripts.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "devices/survey/attached.h"
#include "devices/survey/machine_check.h"

namespace ilf::app {

struct DoctorReport {
    std::vector<devices::Attached> attached;
    std::vector<devices::MachineCheck> machine;
    std::vector<int> core;  ///< processes of the output core; empty: none runs
};
/// kDone or kDevice.
int exitCode(const DoctorReport& report);

void printDoctor(std::ostream& out, const DoctorReport& report);
/// Keys are stable: devices, machine, output_core, looked_for, exit_code.
void printDoctorJson(std::ostream& out, const DoctorReport& report);
/// One line a device: kind, where, name, state.
void printDeviceList(std::ostream& out, const std::vector<devices::Attached>& attached);

}  // namespace ilf::app
