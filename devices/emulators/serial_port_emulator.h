// A serial port that is not there: a lens driver behind a pseudo-terminal, which programs open as any other port.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "core/base/result.h"
#include "devices/emulators/lens_driver.h"

namespace ilf::devices::emulators {

/// Bytes go back and forth on a thread of its own. The port is found at `link`, a symbolic link that stays the same
/// when the cable is pulled and put back; the directory of `link` must be there. A pseudo-terminal knows no baud rate,
/// and no modem lines (devices.md 6.2).
class SerialPortEmulator {
public:
    /// Nanoseconds that never go back; what the device is told as now. Empty: the machine's steady clock.
    using Clock = std::function<std::int64_t()>;

    static Result<std::unique_ptr<SerialPortEmulator>> started(EmulatedLensDriver& device, std::filesystem::path link,
                                                               Clock clock = {});
    ~SerialPortEmulator();
    SerialPortEmulator(const SerialPortEmulator&) = delete;
    SerialPortEmulator& operator=(const SerialPortEmulator&) = delete;

    const std::filesystem::path& link() const;
    /// Pulls the cable: the link is gone, and whoever has the port open reads the end of it. The driver loses its
    /// power.
    void unplug();
    /// Puts it back. In already: nothing happens.
    Result<void> plug();
    bool plugged() const;
    /// Runs `work` while no bytes are on their way: the only time at which the device may be looked at. It is told now.
    void locked(const std::function<void(std::int64_t now_ns)>& work);

private:
    struct Impl;
    explicit SerialPortEmulator(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace ilf::devices::emulators
