// A device that is plugged into this machine, as an operator has to know it.
#pragma once

#include <string>
#include <vector>

namespace ilf::devices {

enum class DeviceKind { projector, converter, lensDriver, camera };
std::string word(DeviceKind kind);  ///< "projector", "converter", "lens driver", "camera"

enum class Readiness {
    ready,         ///< nothing is wrong with it, as far as it was looked at
    notAsked,      ///< it may be opened, but was left alone; `remarks` say why
    inOurUse,      ///< the output core that runs has it
    noPermission,  ///< this user may not open it
    busy,          ///< another program has it, or it could not be claimed
    silent,        ///< it opened and did not answer, or not sensibly
    trouble,       ///< it answered, and something is wrong
    unsupported,   ///< known, but there is no driver for it in this version
    gone,          ///< unplugged while it was looked at
};
std::string word(Readiness state);  ///< "ready", "not-asked", "in-our-use", "no-permission", ...
/// It is there, and cannot be used.
bool unusable(Readiness state);

/// Texts are empty where nothing is known. `troubles` are sentences that say what is wrong and what would help,
/// `remarks` what is worth knowing.
struct Attached {
    DeviceKind kind = DeviceKind::projector;
    Readiness state = Readiness::ready;
    std::string name;     ///< "LightCrafter 4500"
    std::string where;    ///< USB port ("1-2.3": bus, then ports), or what a camera is chosen by
    std::string node;     ///< the file that is opened
    std::string usb;      ///< "0451:6401"; empty for cameras
    std::string product;  ///< as it calls itself
    std::string serial, firmware, mode;
    std::vector<std::string> holders;  ///< "obs (process 123)"
    std::vector<std::string> troubles, remarks;
};

}  // namespace ilf::devices
