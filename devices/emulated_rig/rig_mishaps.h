// The words of RigMishap as faults of emulated devices.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "devices/emulators/fault.h"
#include "devices/link/messages.h"

namespace ilf::devices {

/// "nack", "stuck-frame", ...; none: no such fault.
std::optional<emulators::Mishap> mishapFromWord(std::string_view word);
/// All words, for a sentence: "nack, silence, ...".
std::string mishapWords();
/// `mishap.kind` must be a word. Times 0 is for ever.
emulators::DeviceFault faultOf(const RigMishap& mishap);

}  // namespace ilf::devices
