// The USB devices plugged into this machine: listed, watched, opened.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "devices/usb/usb_link.h"

namespace ilf::devices {

/// A kind of device, by the numbers its maker gave it.
struct UsbModel {
    std::uint16_t vendor = 0, product = 0;
    bool operator==(const UsbModel&) const = default;
};

/// A device that was plugged in or pulled out. Of one that left, its names are no longer known.
struct UsbChange {
    bool arrived = false;
    UsbIdentity device;
};

/// The one owner of libusb. Links opened through it may outlive it. Calls may come from any thread.
class UsbBus {
public:
    /// On a machine without any USB it opens and lists nothing.
    static Result<std::unique_ptr<UsbBus>> open();
    ~UsbBus();
    UsbBus(const UsbBus&) = delete;
    UsbBus& operator=(const UsbBus&) = delete;

    /// Devices of these models that are plugged in, in the order of their paths. They are not opened, so that one in
    /// use or without permission is listed as well.
    Result<std::vector<UsbIdentity>> devices(std::span<const UsbModel> models) const;

    /// Opens the device at `path` and claims its interface; a kernel driver that holds it is sent away until the link
    /// is closed. Refused permission and a device in use are told with what to do.
    Result<std::unique_ptr<UsbLink>> link(const std::string& path, int interfaceNumber);

    /// What came and went since the last call, the newest 256. Where the system tells no news this stays empty: list
    /// now and then.
    std::vector<UsbChange> changes();

private:
    class Watch;
    explicit UsbBus(std::unique_ptr<Watch> watch);
    std::unique_ptr<Watch> watch_;
};

}  // namespace ilf::devices
