// The USB devices this project knows, with or without a driver.
#pragma once

#include <array>

#include "devices/survey/attached.h"
#include "devices/usb/usb_bus.h"

namespace ilf::devices {

struct KnownDevice {
    UsbModel model;
    DeviceKind kind = DeviceKind::projector;
    const char* name = "";
    bool driven = true;   ///< this version has a driver
    bool serial = false;  ///< spoken to through a serial port of the system
};

/// Numbers: devices.md 1 to 3, as the drivers have them.
inline constexpr std::array kKnownDevices{
    KnownDevice{{0x0451, 0x6401}, DeviceKind::projector, "LightCrafter 4500"},
    KnownDevice{{0x0451, 0xC900}, DeviceKind::projector, "LightCrafter 6500 or 9000", false},
    KnownDevice{{0x09DB, 0x00E8}, DeviceKind::converter, "USB-1208FS-Plus"},
    KnownDevice{{0x03EB, 0x2018}, DeviceKind::lensDriver, "Optotune lens driver 4", true, true},
    KnownDevice{{0x0483, 0xA31E}, DeviceKind::lensDriver, "Optotune controller (ICC, ECC or MR-E)", false, true},
};

}  // namespace ilf::devices
