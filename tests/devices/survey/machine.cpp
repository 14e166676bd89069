// What the udev rules cover, and what is read from a machine's files.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "devices/dlpc350/lightcrafter.h"
#include "devices/survey/known_devices.h"
#include "devices/survey/machine_check.h"
#include "devices/survey/udev_rules.h"
#include "devices/usb1208/messages.h"
#include "tests/support/run_program.h"

using namespace ilf;
using namespace ilf::devices;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> ruleLines() {
    std::vector<std::string> lines;
    std::istringstream text(udevRules());
    for (std::string line; std::getline(text, line);)
        if (!line.empty() && line[0] != '#') lines.push_back(line);
    return lines;
}

std::string hex(std::uint16_t number) {
    char digits[8];
    std::snprintf(digits, sizeof digits, "%04x", number);
    return digits;
}

/// Whether a line's conditions hold for a device of this subsystem; keys the rules do not use are not understood.
bool matches(const std::string& line, const std::string& subsystem, const UsbModel& model) {
    static const std::regex condition(R"re((\w+)(?:\{(\w+)\})?=="([^"]*)")re");
    for (std::sregex_iterator it(line.begin(), line.end(), condition), end; it != end; ++it) {
        const std::string key = (*it)[1], name = (*it)[2], value = (*it)[3];
        if (key == "SUBSYSTEM" && value != subsystem) return false;
        if (key == "ENV" && name == "DEVTYPE" && (subsystem != "usb" || value != "usb_device")) return false;
        if (name == "idVendor" && value != hex(model.vendor)) return false;
        if (name == "idProduct" && value != hex(model.product)) return false;
    }
    return true;
}

bool gives(const std::string& assignment, const std::string& subsystem, const UsbModel& model) {
    const auto lines = ruleLines();
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return matches(line, subsystem, model) && line.find(assignment) != std::string::npos;
    });
}

MachineCheck checkNamed(const std::string& id, const SystemPlaces& places) {
    for (const MachineCheck& check : machineChecks(places))
        if (check.id == id) return check;
    return {};
}

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

}  // namespace

TEST_CASE("udev rules: every device the drivers know may be opened, and ModemManager leaves serial ones alone") {
    for (const KnownDevice& known : kKnownDevices) {
        CAPTURE(known.name);
        CHECK(gives("TAG+=\"uaccess\"", known.serial ? "tty" : "usb", known.model));
        CHECK(gives("ENV{ID_MM_DEVICE_IGNORE}=\"1\"", "tty", known.model) == known.serial);
        CHECK(gives("ENV{ID_MM_DEVICE_IGNORE}=\"1\"", "usb", known.model) == known.serial);
    }
    const auto knows = [](const UsbModel& model) {
        return std::any_of(kKnownDevices.begin(), kKnownDevices.end(),
                           [&](const KnownDevice& known) { return known.model == model && known.driven; });
    };
    CHECK(knows({dlpc350::LightCrafter::kVendor, dlpc350::LightCrafter::kProduct}));
    CHECK(knows({usb1208::kVendor, usb1208::kProduct}));
    CHECK(knows({0x03EB, 0x2018}));
    CHECK(!gives("TAG+=\"uaccess\"", "usb", {0x0451, 0x0001}));  // not everything of a maker of many things
    CHECK(gives("TAG+=\"uaccess\"", "usb", {0x09DB, 0x0082}));   // but any converter of this one
}

TEST_CASE("udev rules: every line has conditions and assignments udev understands, and stands below 73-seat-late") {
    static const std::regex part(
        R"re((SUBSYSTEM|ATTRS?\{id(Vendor|Product)\}|ENV\{DEVTYPE\})=="[0-9a-z_]+"|MODE="0660"|GROUP="plugdev"|TAG\+="uaccess"|ENV\{ID_MM_DEVICE_IGNORE\}="1")re");
    REQUIRE(ruleLines().size() >= 5);
    for (const std::string& line : ruleLines()) {
        CAPTURE(line);
        std::size_t from = 0;
        while (from < line.size()) {
            const auto end = std::min(line.find(", ", from), line.size());
            CHECK(std::regex_match(line.substr(from, end - from), part));
            from = end + 2;
        }
    }
    const TemporaryDirectory root;
    REQUIRE(installRules({root.path()}));
    CHECK(installedRules({root.path()}).file.filename() == "70-illuminatedfocus.rules");
    CHECK(installedRules({root.path()}).file.filename().string() < "73-seat-late.rules");
    const fs::path folder = fs::path(root.path()) / "etc/udev/rules.d";
    CHECK(std::distance(fs::directory_iterator(folder), {}) == 1);  // nothing is left of the writing
    CHECK(fs::status(folder / "70-illuminatedfocus.rules").permissions() == fs::perms(0644));
}

TEST_CASE("machine: rules of the system's package count, and older ones in /etc hide them") {
    const TemporaryDirectory root;
    const SystemPlaces places{root.path()};
    CHECK(installedRules(places).file.empty());
    write(places / "usr/lib/udev/rules.d/70-illuminatedfocus.rules", udevRules());
    CHECK(installedRules(places).same);
    const std::string ours = udevRules();
    write(places / "etc/udev/rules.d/70-illuminatedfocus.rules", ours.substr(0, ours.find('\n')) + "\n# older\n");
    CHECK(!installedRules(places).same);
    CHECK(checkNamed("udev-rules", places).standing == Standing::missing);
    CHECK(checkNamed("udev-rules", places).what.find("another version") != std::string::npos);
    REQUIRE(installRules(places));
    CHECK(installedRules(places).same);
}

TEST_CASE("udev rules: an administrator's own file, and a link that switches them off, are left alone and told") {
    const TemporaryDirectory root;
    const SystemPlaces places{root.path()};
    const fs::path file = places / "etc/udev/rules.d/70-illuminatedfocus.rules";
    const std::string theirs = "# ours, not theirs\nSUBSYSTEM==\"usb\", MODE=\"0600\"\n";
    write(file, theirs);
    const auto refused = installRules(places);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().fault == Fault::cannotWrite);
    CHECK(refused.error().what.find("was written by somebody else") != std::string::npos);
    std::ostringstream kept;
    kept << std::ifstream(file).rdbuf();
    CHECK(kept.str() == theirs);
    const MachineCheck check = checkNamed("udev-rules", places);
    CHECK(check.standing == Standing::missing);
    CHECK(check.what.find("written by somebody else") != std::string::npos);

    fs::remove(file);
    fs::create_symlink("/dev/null", file);
    CHECK_FALSE(installRules(places));
    CHECK(fs::read_symlink(file) == "/dev/null");
    fs::remove(file);
    CHECK(installRules(places));
}

TEST_CASE("machine: commands survive a path with a quote, and a user without a name") {
    CHECK(shellWord("/opt/illuminatedfocus") == "'/opt/illuminatedfocus'");
    const std::string odd = "/home/o'neil's $HOME/`x` \"y\"";
    const Ran ran = runProgram("/bin/echo", "-n " + shellWord(odd));
    CHECK(ran.out == odd);
    CHECK(installCommand().starts_with("sudo '"));
    CHECK(joinCommand("video").find('$') == std::string::npos);
}

TEST_CASE("machine: ModemManager is a matter only where it is there and not told to keep away") {
    const TemporaryDirectory root;
    const SystemPlaces places{root.path()};
    CHECK(checkNamed("modem-manager", places).standing == Standing::good);
    write(places / "usr/sbin/ModemManager", "");
    CHECK(checkNamed("modem-manager", places).standing == Standing::missing);
    REQUIRE(installRules(places));
    CHECK(checkNamed("modem-manager", places).standing == Standing::good);
}

TEST_CASE("machine: the projector's display is found by its mode among the connected ones") {
    const TemporaryDirectory root;
    const SystemPlaces places{root.path()};
    CHECK(checkNamed("projector-display", places).standing == Standing::unknown);
    write(places / "sys/class/drm/card0-HDMI-A-1/status", "disconnected\n");
    write(places / "sys/class/drm/card0-HDMI-A-1/modes", "912x1140\n");
    write(places / "sys/class/drm/card0-eDP-1/status", "connected\n");
    write(places / "sys/class/drm/card0-eDP-1/modes", "1920x1080\n1280x800\n");
    const MachineCheck none = checkNamed("projector-display", places);
    CHECK(none.standing == Standing::missing);
    CHECK(none.what == "No display offers 912x1140. Connected: eDP-1 (1920x1080).");
    CHECK(none.commands.size() == 3);
    write(places / "sys/class/drm/card0-HDMI-A-1/status", "connected\n");
    const MachineCheck found = checkNamed("projector-display", places);
    CHECK(found.standing == Standing::good);
    CHECK(found.what == "HDMI-A-1 offers 912x1140, as the projector needs it.");
}

TEST_CASE("machine: whatever is missing comes with what to do") {
    const TemporaryDirectory root;
    for (const MachineCheck& check : machineChecks({root.path()})) {
        CAPTURE(check.id);
        CHECK(!check.what.empty());
        CHECK((check.standing == Standing::missing) == !check.help.empty());
    }
}

TEST_CASE("system files: a USB device's node, release and serial port, and none of them where it is gone") {
    const TemporaryDirectory root;
    const SystemPlaces places{root.path()};
    UsbIdentity device;
    device.path = "1-2.3";
    CHECK(usbNodeOf(device, places).empty());
    CHECK(usbReleaseOf(device, places).empty());
    CHECK(serialPortOf(device, places).empty());
    write(places / "sys/bus/usb/devices/1-2.3/busnum", "1\n");
    write(places / "sys/bus/usb/devices/1-2.3/devnum", "12\n");
    write(places / "sys/bus/usb/devices/1-2.3/bcdDevice", " 0104\n");
    CHECK(usbNodeOf(device, places) == places / "dev/bus/usb/001/012");
    CHECK(usbReleaseOf(device, places) == "1.04");
    fs::create_directories(places / "sys/devices/1-2.3/1-2.3:1.0");
    fs::create_directories(places / "sys/devices/1-2/1-2:1.0");
    fs::create_directories(places / "sys/class/tty/ttyACM0");
    fs::create_directories(places / "sys/class/tty/ttyACM1");
    fs::create_symlink(places / "sys/devices/1-2/1-2:1.0", places / "sys/class/tty/ttyACM0/device");
    fs::create_symlink(places / "sys/devices/1-2.3/1-2.3:1.0", places / "sys/class/tty/ttyACM1/device");
    CHECK(serialPortOf(device, places) == places / "dev/ttyACM1");
}
