#include "devices/survey/system_files.h"

#include <pwd.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const UsbIdentity& device, const SystemPlaces& places) {
    return places / "sys/bus/usb/devices" / device.path;
}

}  // namespace

std::string firstLine(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    const auto blank = " \t\r\n";
    line.erase(line.find_last_not_of(blank) + 1);
    line.erase(0, line.find_first_not_of(blank));
    return line;
}

fs::path usbNodeOf(const UsbIdentity& device, const SystemPlaces& places) {
    const fs::path folder = folderOf(device, places);
    const int bus = std::atoi(firstLine(folder / "busnum").c_str());
    const int number = std::atoi(firstLine(folder / "devnum").c_str());
    if (bus <= 0 || number <= 0) return {};
    char name[32];
    std::snprintf(name, sizeof name, "%03d/%03d", bus, number);
    return places / "dev/bus/usb" / name;
}

std::string usbReleaseOf(const UsbIdentity& device, const SystemPlaces& places) {
    const std::string bcd = firstLine(folderOf(device, places) / "bcdDevice");
    if (bcd.size() != 4) return {};
    return (bcd[0] == '0' ? bcd.substr(1, 1) : bcd.substr(0, 2)) + "." + bcd.substr(2);
}

fs::path serialPortOf(const UsbIdentity& device, const SystemPlaces& places) {
    std::error_code gone;
    fs::directory_iterator ports(places / "sys/class/tty", gone);
    for (const fs::directory_iterator end; !gone && ports != end; ports.increment(gone)) {
        const std::string name = ports->path().filename().string();
        if (!name.starts_with("ttyACM") && !name.starts_with("ttyUSB")) continue;
        std::error_code none;
        // .../1-2/1-2:1.0/tty/ttyACM0: the port's device is an interface of the USB device, or that itself.
        const fs::path owner = fs::canonical(ports->path() / "device", none);
        if (!none && (owner.filename() == device.path || owner.parent_path().filename() == device.path))
            return places / "dev" / name;
    }
    return {};
}

std::string shellWord(const std::string& text) {
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::string userName() {
    const passwd* user = getpwuid(getuid());  // NOLINT(concurrency-mt-unsafe)
    return user != nullptr ? user->pw_name : "";
}

std::string joinCommand(const std::string& groups) {
    const std::string name = userName();
    return "sudo usermod -aG " + groups + " " + (name.empty() ? "YOUR_USER_NAME" : name);
}

bool mayOpen(const fs::path& node) { return ::access(node.c_str(), R_OK | W_OK) == 0; }

}  // namespace ilf::devices
