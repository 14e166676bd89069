// A USB bus that is not there: unmodified libusb programs find emulated devices on it, in this process and in children.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

/// Built on umockdev: sysfs, uevents and usbdevfs of the devices plugged in here are seen by every program that has
/// libumockdev-preload.so.0 preloaded and UMOCKDEV_DIR set (which this class sets, so children inherit it). One at a
/// time in a process. Unloaded or missing, `started` says so in words.
///
/// Limits (devices.md 6.2): a host that waits for a transfer polls, so CPU load and timing mean nothing; bandwidth, hub
/// resets and suspend do not exist.
class UsbHost {
public:
    /// Nanoseconds that never go back; what the devices are told as now. Without one it is the machine's steady clock,
    /// and transfers go on by themselves each millisecond, as under a host controller, however busy the program is that
    /// handed them in. With one they go on when a program asks for them.
    using Clock = std::function<std::int64_t()>;

    static Result<std::unique_ptr<UsbHost>> started(Clock clock = {});
    ~UsbHost();
    UsbHost(const UsbHost&) = delete;
    UsbHost& operator=(const UsbHost&) = delete;

    /// Plugs `device` in at `path` ("1-2": bus 1, port 2; "1-2.3" behind a hub there). It must outlive the host or its
    /// unplugging. Plugged again, it is a new device at the same place, as a real one is.
    Result<void> plug(const std::string& path, EmulatedUsbDevice& device);
    /// Pulls the cable: transfers that wait end with "no device". Nothing at `path`: nothing happens.
    void unplug(const std::string& path);
    bool plugged(const std::string& path) const;
    /// As if another program held the interface: claiming it fails with "busy".
    void setBusy(const std::string& path, bool busy);

    /// Runs `work` while no program talks to a device: the only time at which an emulator may be looked at or told
    /// something. It is told now, and must not plug or unplug.
    void locked(const std::function<void(std::int64_t now_ns)>& work);
    std::int64_t now_ns() const;

    /// What a program that is to see the bus needs in its environment; also set in this process, for its children.
    const std::string& directory() const;
    /// Transfers and bytes the hosts have sent or fetched since the start.
    std::uint64_t transfers() const;

private:
    struct Impl;
    explicit UsbHost(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// The library to preload in programs that are to see the bus.
inline constexpr const char* kUsbPreload = "libumockdev-preload.so.0";

}  // namespace ilf::devices::emulators
