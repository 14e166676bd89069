#include "devices/usb/usb_words.h"

#include <libusb.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

bool isNumber(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool holds(const fs::path& process, const fs::path& node) {
    std::error_code gone;  // processes end while they are looked at
    for (fs::directory_iterator fd(process / "fd", gone), end; !gone && fd != end; fd.increment(gone))
        if (fs::read_symlink(fd->path(), gone) == node) return true;
    return false;
}

std::string nameOf(const fs::path& process) {
    std::ifstream file(process / "comm");
    std::string name;
    std::getline(file, name);
    return name.empty() ? "a program" : name;
}

}  // namespace

std::string inWords(const UsbIdentity& identity) {
    char numbers[16];
    std::snprintf(numbers, sizeof numbers, "%04x:%04x", identity.vendor, identity.product);
    const std::string name = identity.productName.empty() ? std::string("USB device ") + numbers
                                                          : identity.productName + " (" + numbers + ")";
    return name + " at " + identity.path;
}

Error usbError(int code, const UsbIdentity& identity, const std::string& when) {
    const std::string who = inWords(identity), again = "Unplug it and plug it in again.";
    switch (code) {
    case LIBUSB_ERROR_TIMEOUT:
        return {Fault::device, who + " did not answer in time when " + when + ". " + again};
    case LIBUSB_ERROR_NO_DEVICE:
        return {Fault::device, who + " is gone (when " + when + "). Plug it in again."};
    case LIBUSB_ERROR_PIPE:
        return {Fault::device, who + " refused (stalled) when " + when + ". " + again};
    case LIBUSB_ERROR_OVERFLOW:
        return {Fault::device, who + " sent more than was wanted when " + when + ". " + again};
    case LIBUSB_ERROR_IO:
        return {Fault::device, who + " failed when " + when + ". Check its cable."};
    default:
        return {Fault::device, who + " failed when " + when + " (" + libusb_strerror(code) + "). " + again};
    }
}

Error usbPermissionError(const UsbIdentity& identity, const std::string& node) {
    return {Fault::device, "No permission to open " + inWords(identity) + " (" + node +
                               "). Install the project's udev rules (illuminatedfocus doctor says how), then unplug it "
                               "and plug it in again."};
}

Error usbBusyError(const UsbIdentity& identity, const std::vector<std::string>& holders,
                   const std::string& kernelDriver) {
    std::string who;
    for (const std::string& holder : holders)
        who += (who.empty() ? "" : ", ") + holder;
    if (!who.empty())
        return {Fault::device, inWords(identity) + " is in use by " + who + ". Close that and try again."};
    if (!kernelDriver.empty() && kernelDriver != "usbfs")
        return {Fault::device, inWords(identity) + " is held by the kernel's driver " + kernelDriver +
                                   ". Unplug it and plug it in again."};
    return {Fault::device, inWords(identity) +
                               " is in use by a program that cannot be seen from here (another user's, perhaps). Close "
                               "other projector programs and try again."};
}

std::vector<std::string> programsHolding(const fs::path& node, const fs::path& processes) {
    std::vector<std::string> found;
    std::error_code gone;
    for (fs::directory_iterator process(processes, gone), end; !gone && process != end; process.increment(gone)) {
        const std::string id = process->path().filename().string();
        if (!isNumber(id) || id == std::to_string(::getpid()) || !holds(process->path(), node)) continue;
        found.push_back(nameOf(process->path()) + " (process " + id + ")");
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::string kernelDriverOf(const std::string& path, int configuration, int interfaceNumber) {
    std::error_code none;
    const fs::path link = "/sys/bus/usb/devices/" + path + ":" + std::to_string(configuration) + "." +
                          std::to_string(interfaceNumber) + "/driver";
    return fs::read_symlink(link, none).filename().string();
}

}  // namespace ilf::devices
