// What went wrong on USB, in sentences that say what would help.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "devices/usb/usb_link.h"

namespace ilf::devices {

/// "DLPC350 (0451:6401) at 1-2".
std::string inWords(const UsbIdentity& identity);

/// A libusb error code, met `when` the device was "asked for its state".
Error usbError(int code, const UsbIdentity& identity, const std::string& when);

/// Opening was not allowed.
Error usbPermissionError(const UsbIdentity& identity, const std::string& node);
/// The interface is claimed by somebody else; `holders` as programsHolding gives them.
Error usbBusyError(const UsbIdentity& identity, const std::vector<std::string>& holders,
                   const std::string& kernelDriver);

/// Other programs that have `node` open, as "name (process 123)"; of other users' programs only root sees any.
/// `processes` is /proc.
std::vector<std::string> programsHolding(const std::filesystem::path& node,
                                         const std::filesystem::path& processes = "/proc");
/// The kernel driver bound to an interface, from /sys; empty: none.
std::string kernelDriverOf(const std::string& path, int configuration, int interfaceNumber);

}  // namespace ilf::devices
