#include "devices/emulators/usb_sysfs.h"

#include <cstdio>
#include <utility>

namespace ilf::devices::emulators {

namespace {

std::string hex(const Bytes& bytes) {
    std::string text;
    char digits[3];
    for (const std::uint8_t byte : bytes) {
        std::snprintf(digits, sizeof digits, "%02x", unsigned(byte));
        text += digits;
    }
    return text;
}

std::string threeDigits(int number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "%03d", number);
    return digits;
}

bool isRoot(const std::string& path) { return path.starts_with("usb"); }
int busOf(const std::string& path) { return std::stoi(isRoot(path) ? path.substr(3) : path.substr(0, path.find('-'))); }

/// "1-2.3" hangs on "1-2", that on "usb1".
std::string parentOf(const std::string& path) {
    const auto dot = path.rfind('.');
    return dot != std::string::npos ? path.substr(0, dot) : "usb" + path.substr(0, path.find('-'));
}

}  // namespace

bool isUsbPath(const std::string& path) {
    const auto dash = path.find('-');
    if (dash == std::string::npos || path.size() > 24) return false;
    bool digit = false;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const bool isDigit = path[i] >= '0' && path[i] <= '9';
        const bool separates = digit && (i == dash || (i > dash && path[i] == '.'));
        if (!isDigit && !separates) return false;
        digit = isDigit;
    }
    return digit;
}

std::vector<std::string> usbHubsOf(const std::string& path) {
    if (isRoot(path)) return {};
    std::vector<std::string> hubs = usbHubsOf(parentOf(path));
    hubs.push_back(parentOf(path));
    return hubs;
}

std::string sysfsOf(const std::string& path) {
    return (isRoot(path) ? "/devices/pci0000:00/0000:00:14.0" : sysfsOf(parentOf(path))) + "/" + path;
}

std::string usbNodeOf(const std::string& path, int number) {
    return "/dev/bus/usb/" + threeDigits(busOf(path)) + "/" + threeDigits(number);
}

std::string sysfsText(const std::string& path, int number, const UsbDescriptors& descriptors) {
    const std::string node = usbNodeOf(path, number);
    const int bus = busOf(path);
    const Bytes& id = descriptors.device;
    const auto word = [&](std::size_t offset) { return hex({id[offset + 1], id[offset]}); };
    std::string text = "P: " + sysfsOf(path) + "\nN: " + node.substr(std::string("/dev/").size()) +
                       "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: DEVNAME=" + node +
                       "\nE: BUSNUM=" + threeDigits(bus) + "\nE: DEVNUM=" + threeDigits(number) +
                       "\nA: busnum=" + std::to_string(bus) + "\\n\nA: devnum=" + std::to_string(number) +
                       "\\n\nA: bConfigurationValue=1\\n\nA: speed=" + (isRoot(path) ? "480" : "12") +
                       "\\n\nA: devpath=" + (isRoot(path) ? "0" : path.substr(path.find('-') + 1)) +
                       "\\n\nA: idVendor=" + word(8) + "\\n\nA: idProduct=" + word(10) + "\\n\n";
    const std::pair<std::uint8_t, const char*> names[] = {{1, "manufacturer"}, {2, "product"}, {3, "serial"}};
    for (const auto& [index, attribute] : names)
        if (const auto found = descriptors.strings.find(index); found != descriptors.strings.end())
            text += "A: " + std::string(attribute) + "=" + found->second + "\\n\n";
    text += "H: descriptors=" + hex(descriptors.device) + hex(descriptors.configuration) + "\n";
    return text;
}

}  // namespace ilf::devices::emulators
