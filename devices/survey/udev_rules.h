// The udev rules that let this user's programs open the devices, and how they get onto the machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "devices/survey/system_files.h"

namespace ilf::devices {

/// Text of resources/udev/70-illuminatedfocus.rules, as it was when this was built.
std::string udevRules();

struct InstalledRules {
    std::filesystem::path file;  ///< empty: none
    bool same = false;           ///< as the ones of this version
    bool ours = false;           ///< of some version: they begin like these, and are no link
};
/// Looks where udev does; a file in /etc hides one of the same name in /usr/lib.
InstalledRules installedRules(const SystemPlaces& places);

/// What to type so that this program installs them: "sudo '/usr/bin/illuminatedfocus' doctor --install-rules".
std::string installCommand();
/// That, and what does the same without this program, line by line.
std::string rulesByHand();

/// Writes the rules whole or not at all, then lets udev read them and look at what is plugged in, where udevadm is
/// there. A file or link in their place that is not of this program is left alone. Gives sentences of what was done.
/// Errors: `cannotWrite`.
Result<std::vector<std::string>> installRules(const SystemPlaces& places);

}  // namespace ilf::devices
