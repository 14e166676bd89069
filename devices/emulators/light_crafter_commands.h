// What each of the emulated projector's commands carries; private to the emulator.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

/// Not so at all, and as many bytes as the mailbox takes.
inline constexpr int kNo = -1, kAny = -2;

/// A line of the command table (devices.md 1.3).
struct Command {
    int written = kNo, readBack = kNo;  ///< bytes
    bool keepsStill = false;            ///< refused while the sequence runs
    Bytes atPowerOn = {};               ///< zeros where shorter
};

/// By number, CMD2 in the upper byte.
const std::map<unsigned, Command>& commands();
/// Program mode and the boot loader: erased or bricked (devices.md 1.3).
bool forbidden(unsigned command);
/// Whether a payload of the right length is one the command may have; what has no known limits is taken as it is.
bool allowed(unsigned command, std::span<const std::uint8_t> payload);

}  // namespace ilf::devices::emulators
