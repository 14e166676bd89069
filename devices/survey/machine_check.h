// What this machine should have before a show, besides the devices.
#pragma once

#include <string>
#include <vector>

#include "devices/survey/system_files.h"

namespace ilf::devices {

enum class Standing { good, missing, unknown };
std::string word(Standing standing);

/// `help` is what to do about it, as a sentence, then commands to type; both may be empty.
struct MachineCheck {
    std::string id;  ///< "udev-rules", "groups", "modem-manager", "real-time", "locked-memory", "projector-display"
    Standing standing = Standing::good;
    std::string what, help;
    std::vector<std::string> commands;
};

/// In the order in which an operator should see to them. Changes nothing.
std::vector<MachineCheck> machineChecks(const SystemPlaces& places = {});

}  // namespace ilf::devices
