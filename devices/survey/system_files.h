// What the system's own files tell about devices, without opening any.
#pragma once

#include <filesystem>
#include <string>

#include "devices/usb/usb_link.h"

namespace ilf::devices {

/// Where the system keeps what it knows; tests have folders of their own.
struct SystemPlaces {
    std::filesystem::path root = "/";  ///< what "/etc/...", "/sys/..." and "/dev/..." below are under
    std::filesystem::path operator/(const char* path) const { return root / path; }
};

/// The first line of a file without blanks at its ends; empty where there is none.
std::string firstLine(const std::filesystem::path& file);

/// /dev/bus/usb/001/004; empty: no longer there.
std::filesystem::path usbNodeOf(const UsbIdentity& device, const SystemPlaces& places);
/// "4.00" of a device's bcdDevice; empty: not told.
std::string usbReleaseOf(const UsbIdentity& device, const SystemPlaces& places);
/// /dev/ttyACM0 of a USB device that has a serial port; empty: it has none (yet).
std::filesystem::path serialPortOf(const UsbIdentity& device, const SystemPlaces& places);
/// `text` as one word of a shell's command: "it's" is 'it'\''s'.
std::string shellWord(const std::string& text);
/// The name of who runs this; empty: the system has none for the number.
std::string userName();
/// "sudo usermod -aG dialout anna"; YOUR_USER_NAME where there is no name.
std::string joinCommand(const std::string& groups);
/// Whether this user may read and write it.
bool mayOpen(const std::filesystem::path& node);

}  // namespace ilf::devices
