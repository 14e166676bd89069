// A mishap of the emulated rig as it is written on command lines.
#pragma once

#include <string>

#include "devices/link/messages.h"

namespace ilf::devices {

/// "DEVICE:KIND[:AFTER[:TIMES[:AMOUNT]]]", such as "projector:unplug" or "lenses:clock-drift:0:0:200"; see RigMishap.
/// Whether there is such a device and kind, the rig knows.
Result<RigMishap> mishapFrom(const std::string& text);

}  // namespace ilf::devices
