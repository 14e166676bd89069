#include "devices/emulators/usb_device.h"

#include <algorithm>
#include <initializer_list>

namespace ilf::devices::emulators {

namespace {

void append(Bytes& bytes, std::initializer_list<int> values) {
    for (const int value : values)
        bytes.push_back(static_cast<std::uint8_t>(value));
}

/// UTF-16; index 0 lists the languages: US English.
Bytes stringDescriptor(const UsbDescriptors& descriptors, std::uint8_t index) {
    if (index == 0) return {4, 3, 0x09, 0x04};
    const auto found = descriptors.strings.find(index);
    if (found == descriptors.strings.end()) return {};
    Bytes bytes = {static_cast<std::uint8_t>(2 + 2 * found->second.size()), 3};
    for (const char letter : found->second)
        append(bytes, {letter, 0});
    return bytes;
}

}  // namespace

// Layouts: USB 2.0 specification, chapter 9.6; HID 1.11, chapter 6.2.1.
UsbDescriptors usbDescriptors(const UsbShape& shape) {
    UsbDescriptors made;
    const auto string = [&](std::uint8_t index, const std::string& text) {
        if (text.empty()) return 0;
        made.strings[index] = text;
        return int(index);
    };
    const int manufacturer = string(1, shape.manufacturer), name = string(2, shape.name),
              serial = string(3, shape.serial);
    append(made.device, {18, 1, 0x00, 0x02, 0, 0, 0, 64, shape.vendor & 0xFF, shape.vendor >> 8, shape.product & 0xFF,
                         shape.product >> 8, 0x00, 0x01, manufacturer, name, serial, 1});

    const bool hid = shape.interfaceClass == 3;
    const int total = 9 + 9 + (hid ? 9 : 0) + 7 * int(shape.endpoints.size());
    append(made.configuration, {9, 2, total & 0xFF, total >> 8, 1, 1, 0, 0x80, 50});
    append(made.configuration, {9, 4, 0, 0, int(shape.endpoints.size()), shape.interfaceClass, 0, 0, 0});
    if (hid) append(made.configuration, {9, 0x21, 0x11, 0x01, 0, 1, 0x22, 34, 0});
    for (const UsbEndpointShape& endpoint : shape.endpoints)
        append(made.configuration, {7, 5, endpoint.address, endpoint.attributes, endpoint.packet & 0xFF,
                                    endpoint.packet >> 8, endpoint.attributes == 3 ? 1 : 0});
    if (hid) made.kernelDriver = "usbhid";
    return made;
}

// USB 2.0 specification, chapter 9.4.
UsbTransfer controlTransfer(EmulatedUsbDevice& device, const UsbDescriptors& descriptors, const ControlSetup& setup,
                            std::span<std::uint8_t> data, std::int64_t now_ns) {
    if ((setup.requestType & 0x60U) != 0) return device.control(setup, data, now_ns);
    constexpr std::uint8_t kGetStatus = 0, kGetDescriptor = 6, kGetConfiguration = 8;
    Bytes answer;
    if (setup.request == kGetStatus) answer = {0, 0};
    if (setup.request == kGetConfiguration) answer = {1};
    if (setup.request == kGetDescriptor) {
        switch (setup.value >> 8U) {
        case 1:
            answer = descriptors.device;
            break;
        case 2:
            answer = descriptors.configuration;
            break;
        case 3:
            answer = stringDescriptor(descriptors, static_cast<std::uint8_t>(setup.value));
            break;
        default:
            break;
        }
    }
    if ((setup.requestType & 0x80U) == 0) return {UsbAnswer::done, data.size()};
    if (answer.empty()) return {UsbAnswer::stall, 0};
    const std::size_t bytes = std::min(answer.size(), data.size());
    std::copy_n(answer.begin(), bytes, data.begin());
    return {UsbAnswer::done, bytes};
}

}  // namespace ilf::devices::emulators
