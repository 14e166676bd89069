// Rigs by a word: the emulated one, or a rig's file.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/document/rig.h"

namespace ilf::app {

inline constexpr const char* kSimulatedRig = "simulated";
inline constexpr const char* kEmulatedRig = "emulated";

/// The rig of `--rig emulated`: a LightCrafter 4500 at USB 1-2 with six slots of four bits a sweep, and a
/// USB-1208FS-Plus at 1-3 with both lenses, as the emulators are wired. Its static calibration was recorded from the
/// emulated lens of preset datasheet. Never measured on hardware.
Rig emulatedRig();
/// "emulated", or "emulated:N": the same with N bits a slot, and as many slots as the projector then shows.
bool isEmulatedRig(std::string_view word);

/// "simulated" (today's default rig), "emulated" or "emulated:N" (isEmulatedRig), or the path of a rig's file.
Result<Rig> rigFrom(const std::string& wordOrFile);

}  // namespace ilf::app
