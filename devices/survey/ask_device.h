// Asks one device how it is, without changing anything in it.
#pragma once

#include <memory>

#include "devices/clock.h"
#include "devices/serial/serial_link.h"
#include "devices/survey/attached.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices {

// Each fills in what it is told, state among it; an error means that the device did not answer sensibly.

/// Running patterns are disturbed for a moment.
Result<void> askLightCrafter(Attached& device, std::unique_ptr<UsbLink> link, const Clock& clock);
/// Its scans go on undisturbed.
Result<void> askConverter(Attached& device, UsbLink& link);
/// Never says "Start", which would set the current to 0: its mode and current stay as they are.
Result<void> askLensDriver(Attached& device, SerialLink& link, const Clock& clock);

}  // namespace ilf::devices
