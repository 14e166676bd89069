// `doctor` and `--list-devices`: what is attached, whether it can be used, and what to do before the doors open.
#pragma once

#include <string>

namespace ilf::app {

struct DoctorOptions {
    bool json = false;
    bool ask = false;           ///< devices, even while an output core of ours runs (never those it holds)
    bool installRules = false;  ///< instead
    std::string root = "/";     ///< another system's files, for tests
};
/// Exit code 3 when a device is there but cannot be used; what the machine lacks alone is told and is no failure.
int doctorCommand(const DoctorOptions& options);

/// One line for each device, without opening any.
int listDevicesCommand();

}  // namespace ilf::app
