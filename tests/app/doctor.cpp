// `doctor` and `--list-devices` as programs: what an operator reads with nothing, good devices and bad ones attached.
// The emulated bus needs libumockdev-preload.so.0 in LD_PRELOAD, as ctest sets it.
#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "devices/emulators/daq.h"
#include "devices/emulators/light_crafter.h"
#include "devices/emulators/serial_port_emulator.h"
#include "devices/emulators/usb_host.h"
#include "devices/link/runtime_directory.h"
#include "tests/support/run_program.h"

using namespace ilf;
using namespace ilf::devices::emulators;
using nlohmann::json;

namespace {

std::atomic<std::int64_t> time_ns{0};

/// One bus for the whole executable: umockdev allows one in a process. None where it is not preloaded.
UsbHost* bus() {
    static const Result<std::unique_ptr<UsbHost>> host = UsbHost::started([] { return time_ns += 200'000; });
    if (host) return host->get();
    MESSAGE("SKIPPED: ", host.error().what);
    return nullptr;
}

struct Plugged {
    std::string path;
    Plugged(std::string at, EmulatedUsbDevice& device) : path(std::move(at)) { REQUIRE(bus()->plug(path, device)); }
    ~Plugged() { bus()->unplug(path); }
    Plugged(const Plugged&) = delete;
    Plugged& operator=(const Plugged&) = delete;
};

void plugVideo(EmulatedLightCrafter& projector, const VideoSource& source) {
    bus()->locked([&](std::int64_t now_ns) { projector.plugVideo(source, now_ns); });
    time_ns += 1'000'000'000;  // until it is locked
}

/// A machine without a core of ours and without rules, whatever runs and is installed on the one that tests.
struct Machine {
    TemporaryDirectory runtime, root;
    Ran doctor(const std::string& options = "") const { return ran("doctor " + options); }
    /// With the files of `root` instead of the machine's.
    Ran inRoot(const std::string& options = "") const { return ran("doctor --root " + root.path() + " " + options); }
    Ran ran(const std::string& arguments) const {
        return readAsCalled(ILF_STUDIO_PATH, arguments, "ILF_RUNTIME_DIR=" + runtime.path());
    }
    json report(const std::string& options = "") const { return json::parse(doctor("--json " + options).out); }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

json checkNamed(const json& report, const std::string& id) {
    for (const json& check : report["machine"])
        if (check["id"] == id) return check;
    return {};
}

/// A USB device with numbers and no behaviour: its serial port is somewhere else.
class NumbersOnly final : public EmulatedUsbDevice {
public:
    NumbersOnly(std::uint16_t vendor, std::uint16_t product, std::string name)
        : shape_{vendor, product, 2, "Maker", std::move(name), "", {{0x81, 3, 64}}} {}
    UsbDescriptors descriptors() const override { return usbDescriptors(shape_); }
    UsbTransfer out(std::uint8_t, std::span<const std::uint8_t>, std::int64_t) override { return {UsbAnswer::stall}; }
    UsbTransfer in(std::uint8_t, std::span<std::uint8_t>, std::int64_t) override { return {UsbAnswer::stall}; }
    UsbTransfer control(const ControlSetup&, std::span<std::uint8_t>, std::int64_t) override {
        return {UsbAnswer::stall};
    }
    void clearHalt(std::uint8_t, std::int64_t) override {}
    void unplugged(std::int64_t) override {}

private:
    UsbShape shape_;
};

}  // namespace

TEST_CASE("doctor: with nothing attached it says what was looked for and how to go on, and nothing is wrong") {
    if (bus() == nullptr) return;
    const Machine machine;
    const Ran ran = machine.inRoot();
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "No projector, converter, lens driver or camera is attached."));
    CHECK(contains(ran.out, "USB 0451:6401  LightCrafter 4500 (projector)"));
    CHECK(contains(ran.out, "everything works with simulated devices"));
    CHECK(contains(ran.out, "./run.sh"));
    CHECK(contains(ran.out, "doctor --install-rules"));
    CHECK(contains(ran.out, "No display can be asked on this machine"));

    const json report = json::parse(machine.inRoot("--json").out);
    CHECK(report["devices"] == json::array());
    CHECK(report["looked_for"].size() >= 4);
    CHECK(report["output_core"]["running"] == false);
    CHECK(report["exit_code"] == 0);
    CHECK(checkNamed(report, "udev-rules")["standing"] == "missing");
    CHECK(checkNamed(report, "projector-display")["standing"] == "unknown");
    const Ran list = machine.ran("--list-devices");
    if (!std::filesystem::exists("/dev/v4l")) CHECK(contains(list.out, "No device is attached"));
}

TEST_CASE("doctor: a projector that gets its video and a converter are ready, and nothing in them was changed") {
    if (bus() == nullptr) return;
    const Machine machine;
    EmulatedLightCrafter projector;
    EmulatedDaq converter;
    const Plugged a("1-5.1", projector), b("1-4", converter);
    plugVideo(projector, {});
    const Ran ran = machine.doctor();
    CHECK_MESSAGE(ran.code == 0, ran.out);
    CHECK(contains(ran.out, "READY         LightCrafter 4500 (projector, 0451:6401)"));
    CHECK(contains(ran.out, "USB port 1-5.1, /dev/bus/usb/001/"));
    CHECK(contains(ran.out, "calls itself \"DLPC350\""));
    CHECK(contains(ran.out, "firmware 4.4.0"));
    CHECK(contains(ran.out, "video mode, gets 912x1140 at 59.94 Hz"));
    CHECK(contains(ran.out, "READY         USB-1208FS-Plus (converter, 09db:00e8)"));
    CHECK(contains(ran.out, "outputs stand still"));
    CHECK(contains(ran.out, "No attached device is in trouble."));

    const json report = machine.report();
    REQUIRE(report["devices"].size() >= 2);
    const json &first = report["devices"][0], &second = report["devices"][1];
    CHECK(first["kind"] == "projector");
    CHECK(first["state"] == "ready");
    CHECK(first["usable"] == true);
    CHECK(first["where"] == "1-5.1");
    CHECK(first["troubles"] == json::array());
    CHECK(second["kind"] == "converter");
    CHECK(second["serial"] == "01F0A1B2");

    bus()->locked([&](std::int64_t now_ns) {
        CHECK(!projector.harmed());
        CHECK(projector.ledCurrentWrites() == 0);
        CHECK(!projector.patternMode(now_ns));
        CHECK(converter.blinks() == 0);
        CHECK(converter.takeOutput(now_ns).empty());
    });
    const std::size_t asked = projector.messages();
    CHECK(asked > 0);
    const Ran list = machine.ran("--list-devices");
    CHECK(list.code == 0);
    CHECK(contains(list.out, "projector   ready         LightCrafter 4500        1-5.1 /dev/bus/usb/"));
    CHECK(contains(list.out, "converter   ready         USB-1208FS-Plus          1-4 /dev/bus/usb/"));
    CHECK(projector.messages() == asked);  // a list asks nobody
}

TEST_CASE("doctor: a projector without its picture, or with another one, cannot be used, and it is said what helps") {
    if (bus() == nullptr) return;
    const Machine machine;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-2", projector);
    const Ran dark = machine.doctor();
    CHECK(dark.code == 3);
    CHECK(contains(dark.out, "NOT READY     LightCrafter 4500"));
    CHECK(contains(dark.out, "no picture locked"));
    CHECK(contains(machine.report()["devices"][0]["troubles"][0],
                   "Check the cable, and that its display is switched on"));

    plugVideo(projector, {1280, 800, 60.0});
    const json wrong = machine.report();
    CHECK(wrong["exit_code"] == 3);
    CHECK(wrong["devices"][0]["state"] == "trouble");
    CHECK(wrong["devices"][0]["usable"] == false);
    CHECK(wrong["devices"][0]["mode"] == "video mode, gets 1280x800 at 60.00 Hz");
    CHECK(contains(wrong["devices"][0]["troubles"][0], "only at exactly 912x1140"));
}

TEST_CASE("doctor: busy and silent devices are told apart, and one pulled out in the middle is only a line") {
    if (bus() == nullptr) return;
    const Machine machine;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-2", projector);
    plugVideo(projector, {});
    bus()->setBusy("1-2", true);
    const Ran busy = machine.doctor();
    CHECK(busy.code == 3);
    CHECK(contains(busy.out, "IN USE        LightCrafter 4500"));
    CHECK(contains(busy.out, "-> DLPC350 (0451:6401) at 1-2 is in use by a program"));
    CHECK(machine.report()["devices"][0]["state"] == "busy");
    bus()->setBusy("1-2", false);

    bus()->locked([&](std::int64_t) { projector.setFaults({{Mishap::silence}}); });
    const Ran silent = machine.doctor();
    CHECK(silent.code == 3);
    CHECK(contains(silent.out, "NO ANSWER     LightCrafter 4500"));

    bus()->locked([&](std::int64_t) { projector.setFaults({{Mishap::unplug, 200}}); });
    const json gone = machine.report();
    CHECK(gone["exit_code"] == 0);
    REQUIRE(gone["devices"].size() >= 1);
    CHECK(gone["devices"][0]["state"] == "gone");
    CHECK(contains(gone["devices"][0]["troubles"][0], "unplugged while it was looked at"));
}

TEST_CASE("doctor: a device this user may not open is told with the rules to install, and no account needs a name") {
    if (bus() == nullptr) return;
    namespace fs = std::filesystem;
    const Machine machine;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-2", projector);
    // The node as the system's files name it, which nobody may open.
    const fs::path root = machine.root.path(), usb = root / "sys/bus/usb/devices/1-2";
    fs::create_directories(usb);
    fs::create_directories(root / "dev/bus/usb/001");
    std::ofstream(usb / "busnum") << "1\n";
    std::ofstream(usb / "devnum") << "7\n";
    std::ofstream(root / "dev/bus/usb/001/007") << "";
    fs::permissions(root / "dev/bus/usb/001/007", fs::perms::none);
    std::string other;
    if (geteuid() == 0) {
        // Root may open everything, so somebody else looks: a number without a name, as in containers.
        other = " setpriv --reuid=54321 --regid=54321 --clear-groups";
        fs::permissions(root, fs::perms(0755));
        fs::permissions(machine.runtime.path(), fs::perms(0755));
        // The bus has its listeners put sockets there.
        fs::permissions(bus()->directory(), fs::perms(0777));
        for (const auto& entry : fs::recursive_directory_iterator(bus()->directory()))
            if (entry.is_directory() && !entry.is_symlink()) fs::permissions(entry.path(), fs::perms(0777));
    }
    const auto asked = [&](const std::string& options) {
        return readAsCalled(ILF_STUDIO_PATH, "doctor --root " + root.string() + " " + options,
                            "ILF_RUNTIME_DIR=" + machine.runtime.path() + other);
    };
    const Ran ran = asked("");
    CHECK(ran.code == 3);
    CHECK_MESSAGE(contains(ran.out, "NO PERMISSION LightCrafter 4500"), ran.out);
    CHECK(contains(ran.out, "You may not open " + root.string() + "/dev/bus/usb/001/007."));
    CHECK_FALSE(contains(ran.out, "$USER"));
    const json report = json::parse(asked("--json").out);
    CHECK(report["devices"][0]["state"] == "no-permission");
    CHECK(report["devices"][0]["usable"] == false);
    CHECK(
        contains(report["devices"][0]["troubles"][0], "doctor --install-rules, then unplug it and plug it in again."));
    CHECK(projector.messages() == 0);
}

TEST_CASE("doctor: while an output core runs, devices are asked only with --ask") {
    if (bus() == nullptr) return;
    const Machine machine;
    const auto core = devices::FileLock::tryTake(devices::playerLock(machine.runtime.path()));
    REQUIRE((core && *core));
    EmulatedLightCrafter projector;
    const Plugged plugged("1-2", projector);
    plugVideo(projector, {});
    const Ran left = machine.doctor();
    CHECK(left.code == 0);
    CHECK(contains(left.out, "NOT ASKED     LightCrafter 4500"));
    CHECK(contains(left.out, "--ask"));
    CHECK(projector.messages() == 0);
    const json asked = machine.report("--ask");
    CHECK(asked["devices"][0]["state"] == "ready");
    CHECK(asked["output_core"]["running"] == true);
    CHECK(projector.messages() > 0);
}

TEST_CASE("doctor: a lens driver's port is found through the system's files and asked without moving the lens") {
    if (bus() == nullptr) return;
    namespace fs = std::filesystem;
    const Machine machine;
    const fs::path root = machine.root.path();
    NumbersOnly usb(0x03EB, 0x2018, "Optotune LD");
    const Plugged plugged("1-4", usb);
    CHECK(contains(machine.inRoot().out, "-> It has no serial port yet."));

    fs::create_directories(root / "sys/devices/1-4/1-4:1.0");
    fs::create_directories(root / "sys/class/tty/ttyACM0");
    fs::create_directories(root / "dev");
    fs::create_symlink(root / "sys/devices/1-4/1-4:1.0", root / "sys/class/tty/ttyACM0/device");
    EmulatedLensDriver driver;
    const auto port = SerialPortEmulator::started(driver, root / "dev/ttyACM0");
    REQUIRE(port);
    const Ran ran = machine.inRoot();
    CHECK_MESSAGE(ran.code == 0, ran.out);
    CHECK(contains(ran.out, "READY         Optotune lens driver 4 (lens driver, 03eb:2018)"));
    CHECK(contains(ran.out, ", type F; "));
    CHECK(contains(ran.out, "The lens is at "));
    CHECK(driver.memoryWrites() == 0);
    CHECK(!driver.harmed());

    (*port)->locked([&](std::int64_t) { driver.setFaults({{Mishap::overTemperature, 0, 1, 40.0}}); });
    CHECK(contains(machine.inRoot().out, "switch its driver off and let it cool"));
    (*port)->locked([&](std::int64_t) { driver.setFaults({{Mishap::silence}}); });
    const json silent = json::parse(machine.inRoot("--json").out);
    CHECK(silent["devices"][0]["state"] == "silent");
    CHECK(silent["exit_code"] == 3);
}

TEST_CASE("doctor: the USB rules are installed whole, found again, and refused in words where that cannot be") {
    if (bus() == nullptr) return;
    const Machine machine;
    const Ran first = machine.inRoot("--install-rules");
    CHECK_MESSAGE(first.code == 0, first.out);
    CHECK(contains(first.out, "Wrote " + machine.root.path() + "/etc/udev/rules.d/70-illuminatedfocus.rules."));
    CHECK(contains(machine.inRoot("--install-rules").out, "already those of this version"));
    CHECK(checkNamed(json::parse(machine.inRoot("--json").out), "udev-rules")["standing"] == "good");

    std::string firstLine;
    std::getline(std::ifstream(machine.root / "etc/udev/rules.d/70-illuminatedfocus.rules"), firstLine);
    std::ofstream(machine.root / "etc/udev/rules.d/70-illuminatedfocus.rules") << firstLine << "\n# older\n";
    CHECK(contains(checkNamed(json::parse(machine.inRoot("--json").out), "udev-rules")["what"],
                   "are those of another version"));
    CHECK(machine.inRoot("--install-rules").code == 0);
    CHECK(checkNamed(json::parse(machine.inRoot("--json").out), "udev-rules")["standing"] == "good");

    std::ofstream(machine.root / "etc/udev/rules.d/70-illuminatedfocus.rules") << "# an administrator's\n";
    const Ran theirs = machine.inRoot("--install-rules");
    CHECK(theirs.code == 1);
    CHECK(contains(theirs.out, "was written by somebody else"));

    std::ofstream(machine.root / "file") << "in the way";
    const Ran refused = machine.ran("doctor --install-rules --root " + machine.root.path() + "/file");
    CHECK(refused.code == 1);
    CHECK(contains(refused.out, "cannot be made"));
}
