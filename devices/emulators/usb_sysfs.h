// Where an emulated USB device stands in sysfs, and the text by which umockdev makes it known there.
#pragma once

#include <string>
#include <vector>

#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

/// Such as "1-2.3": bus, then ports.
bool isUsbPath(const std::string& path);
/// "usb1", "1-2" for "1-2.3": real devices hang on hubs, and programs follow the chain to tell the place.
std::vector<std::string> usbHubsOf(const std::string& path);

// Of a path or a hub.

/// "/devices/.../usb1/1-2".
std::string sysfsOf(const std::string& path);
/// "/dev/bus/usb/001/004".
std::string usbNodeOf(const std::string& path, int number);
/// As umockdev_testbed_add_from_string takes it. A root hub has 480 Mbit/s, all else full speed.
std::string sysfsText(const std::string& path, int number, const UsbDescriptors& descriptors);

}  // namespace ilf::devices::emulators
