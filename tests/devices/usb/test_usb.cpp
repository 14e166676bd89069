#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "devices/usb/usb_bus.h"
#include "devices/usb/usb_news.h"
#include "devices/usb/usb_words.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

const UsbIdentity kBoard{0x0451, 0x6401, "1-2.3", "DLPC350", ""};
constexpr int kNoDevice = -4;  // libusb's

}  // namespace

TEST_CASE("usb: a device is named by what it says and where it is") {
    CHECK(inWords(kBoard) == "DLPC350 (0451:6401) at 1-2.3");
    CHECK(inWords(UsbIdentity{0x09DB, 0x00E8, "2-1", "", ""}) == "USB device 09db:00e8 at 2-1");
}

TEST_CASE("usb: every failure says which device, when, and what would help") {
    for (const int code : {-1, -2, -3, kNoDevice, -5, -6, -7, -8, -9, -10, -11, -12, -99}) {
        const Error error = usbError(code, kBoard, "asked for its state");
        CAPTURE(error.what);
        CHECK(error.fault == Fault::device);
        CHECK(error.what.starts_with("DLPC350 (0451:6401) at 1-2.3 "));
        CHECK(error.what.find("when asked for its state") != std::string::npos);
        // What would help comes last.
        CHECK((error.what.ends_with("lug it in again.") || error.what.ends_with("Check its cable.")));
    }
    CHECK(usbError(kNoDevice, kBoard, "asked for its state").what.find("Plug it in again.") != std::string::npos);
    CHECK(usbPermissionError(kBoard, "/dev/bus/usb/001/004").what.find("udev rules") != std::string::npos);
}

TEST_CASE("usb: a device in use is told with who holds it") {
    CHECK(usbBusyError(kBoard, {"LightCrafter (process 77)"}, "").what ==
          "DLPC350 (0451:6401) at 1-2.3 is in use by LightCrafter (process 77). Close that and try again.");
    CHECK(usbBusyError(kBoard, {}, "usbhid").what.find("kernel's driver usbhid") != std::string::npos);
    CHECK(usbBusyError(kBoard, {}, "usbfs").what.find("cannot be seen from here") != std::string::npos);
}

TEST_CASE("usb: programs that hold a node are found among the processes") {
    const auto node = std::filesystem::temp_directory_path() / ("ilf-test-node-" + std::to_string(::getpid()));
    std::ofstream ours(node);
    CHECK(programsHolding(node).empty());
    FILE* shell = ::popen(("exec 3< " + node.string() + "; read end").c_str(), "w");
    REQUIRE(shell != nullptr);
    std::vector<std::string> found;
    // The shell may take its time on a busy machine.
    for (int tries = 0; tries < 12'000 && found.empty(); ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        found = programsHolding(node);
    }
    ::pclose(shell);
    REQUIRE(found.size() == 1);
    CHECK(found.front().find("sh (process ") != std::string::npos);

    // Another program, as /proc would show it.
    const auto processes = std::filesystem::temp_directory_path() / ("ilf-test-proc-" + std::to_string(::getpid()));
    std::filesystem::create_directories(processes / "99999999" / "fd");
    std::filesystem::create_directories(processes / "self" / "fd");
    std::filesystem::create_symlink(node, processes / "99999999" / "fd" / "5");
    std::ofstream(processes / "99999999" / "comm") << "dlp_gui\n";
    CHECK(programsHolding(node, processes) == std::vector<std::string>{"dlp_gui (process 99999999)"});
    std::filesystem::remove_all(processes);
    std::filesystem::remove(node);
    CHECK(programsHolding(node, processes).empty());
}

TEST_CASE("usb: news that nobody fetches do not pile up, and the newest are kept") {
    UsbNews news;
    for (int i = 0; i < 10'000; ++i)
        news.add({i % 2 == 0, {0x0451, 0x6401, std::to_string(i), "", ""}});
    const auto changes = news.taken();
    REQUIRE(changes.size() == UsbNews::kMost);
    CHECK(changes.back().device.path == "9999");
    CHECK(changes.front().device.path == std::to_string(10'000 - UsbNews::kMost));
    CHECK(news.taken().empty());
}

TEST_CASE("usb: without the device the bus lists nothing and says where it should be") {
    auto bus = UsbBus::open();
    REQUIRE(bus);
    const std::array<UsbModel, 1> none{UsbModel{0xFFFF, 0xFFFE}};
    CHECK((*bus)->devices(none)->empty());
    CHECK((*bus)->link("99-1", 0).error().fault == Fault::notFound);
    CHECK((*bus)->link("99-1", 0).error().what.find("plugged in at 99-1") != std::string::npos);
    (void)(*bus)->changes();
    CHECK((*bus)->changes().empty());
}
