// An emulated USB device as a host meets it: descriptors, transfers and control requests, with time as an argument.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ilf::devices::emulators {

using Bytes = std::vector<std::uint8_t>;

/// What became of a transfer. `busy`: the device has taken or given some of it and asks to be asked again (it answers
/// NAK on the bus). `gone`: the cable was pulled in the middle.
enum class UsbAnswer : std::uint8_t { done, busy, stall, gone };

struct UsbTransfer {
    UsbAnswer answer = UsbAnswer::done;
    std::size_t bytes = 0;  ///< moved by this call
};

/// The eight bytes of a control transfer's set-up packet.
struct ControlSetup {
    std::uint8_t requestType = 0, request = 0;
    std::uint16_t value = 0, index = 0, length = 0;
};

/// The raw descriptors of a device with one configuration, and the kernel driver that would hold its interface 0.
struct UsbDescriptors {
    Bytes device;                                 ///< 18 bytes
    Bytes configuration;                          ///< with its interfaces and endpoints
    std::map<std::uint8_t, std::string> strings;  ///< by index; ASCII
    std::string kernelDriver;                     ///< "usbhid"; empty: none
};

struct UsbEndpointShape {
    std::uint8_t address = 0;     ///< bit 7: towards the host
    std::uint8_t attributes = 0;  ///< 2 bulk, 3 interrupt
    std::uint16_t packet = 64;
};
struct UsbShape {
    std::uint16_t vendor = 0, product = 0;
    std::uint8_t interfaceClass = 0;  ///< 3: HID
    std::string manufacturer, name, serial;
    std::vector<UsbEndpointShape> endpoints;
};
/// Descriptors of a full-speed device with one interface; a HID interface gets a HID descriptor too.
UsbDescriptors usbDescriptors(const UsbShape& shape);

/// Time is in nanoseconds of one clock that never goes back. Not for two threads at once.
class EmulatedUsbDevice {
public:
    virtual ~EmulatedUsbDevice() = default;

    virtual UsbDescriptors descriptors() const = 0;
    /// Interrupt or bulk, from the host. After `busy` it is called again with what is left.
    virtual UsbTransfer out(std::uint8_t endpoint, std::span<const std::uint8_t> data, std::int64_t now_ns) = 0;
    /// Interrupt or bulk, to the host. After `busy` it is called again with the room that is left.
    virtual UsbTransfer in(std::uint8_t endpoint, std::span<std::uint8_t> room, std::int64_t now_ns) = 0;
    /// Vendor requests; standard ones are the host emulator's.
    virtual UsbTransfer control(const ControlSetup& setup, std::span<std::uint8_t> data, std::int64_t now_ns) = 0;
    virtual void clearHalt(std::uint8_t endpoint, std::int64_t now_ns) = 0;
    /// The cable was pulled; a device that lives on it loses its power.
    virtual void unplugged(std::int64_t now_ns) = 0;
    /// When a device that has left the bus by itself (a reset) is back on it.
    virtual std::optional<std::int64_t> backOnBusAt() const { return std::nullopt; }
};

/// A control transfer as a device's bus controller answers it: standard requests from the descriptors, the rest from
/// the device.
UsbTransfer controlTransfer(EmulatedUsbDevice& device, const UsbDescriptors& descriptors, const ControlSetup& setup,
                            std::span<std::uint8_t> data, std::int64_t now_ns);

}  // namespace ilf::devices::emulators
