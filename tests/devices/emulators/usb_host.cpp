// Raw libusb against the emulated bus; no driver of ours. Needs libumockdev-preload.so.0 in LD_PRELOAD, as ctest sets
// it, and says so where it is missing.
#include <doctest/doctest.h>
#include <libusb.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/emulators/daq.h"
#include "devices/emulators/light_crafter.h"
#include "devices/emulators/usb_host.h"
#include "tests/support/run_program.h"

using namespace ilf;
using namespace ilf::devices::emulators;

namespace {

/// One bus for the whole executable: umockdev allows one in a process. None where it is not preloaded.
UsbHost* bus() {
    // Its time goes on by a fifth of a millisecond whenever a device is asked something, so that nothing here depends
    // on how busy the machine is.
    static std::atomic<std::int64_t> time_ns{0};
    static const Result<std::unique_ptr<UsbHost>> host = UsbHost::started([] { return time_ns += 200'000; });
    if (host) return host->get();
    MESSAGE("SKIPPED: ", host.error().what);
    return nullptr;
}

struct Libusb {
    libusb_context* context = nullptr;
    Libusb() { REQUIRE(libusb_init(&context) == 0); }
    ~Libusb() { libusb_exit(context); }
    Libusb(const Libusb&) = delete;
    Libusb& operator=(const Libusb&) = delete;

    /// Turns the crank until there is such a device, for a second at most.
    libusb_device_handle* open(std::uint16_t vendor, std::uint16_t product) const {
        for (int i = 0; i < 100; ++i) {
            if (auto* handle = libusb_open_device_with_vid_pid(context, vendor, product)) return handle;
            timeval wait{0, 10000};
            libusb_handle_events_timeout(context, &wait);
        }
        return nullptr;
    }
};

struct Plugged {
    std::string path;
    Plugged(std::string at, EmulatedUsbDevice& device) : path(std::move(at)) { REQUIRE(bus()->plug(path, device)); }
    ~Plugged() { bus()->unplug(path); }
    Plugged(const Plugged&) = delete;
    Plugged& operator=(const Plugged&) = delete;
};

using Report = std::array<unsigned char, 64>;

Report request(std::initializer_list<int> bytes) {
    Report report{};
    std::size_t next = 0;
    for (const int byte : bytes)
        report[next++] = static_cast<unsigned char>(byte);
    return report;
}

int send(libusb_device_handle* handle, Report report, int& moved) {
    return libusb_interrupt_transfer(handle, 0x01, report.data(), int(report.size()), &moved, 1000);
}
int receive(libusb_device_handle* handle, Report& report, int& moved, unsigned limit_ms = 1000) {
    return libusb_interrupt_transfer(handle, 0x81, report.data(), int(report.size()), &moved, limit_ms);
}

}  // namespace

TEST_CASE("usb: an unmodified libusb program finds the emulated projector, opens it and reads its version") {
    if (bus() == nullptr) return;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-2.3", projector);
    const Libusb usb;
    libusb_device_handle* handle = usb.open(0x0451, 0x6401);
    REQUIRE(handle != nullptr);

    std::array<unsigned char, 64> text{};
    CHECK(libusb_get_string_descriptor_ascii(handle, 2, text.data(), int(text.size())) == 7);
    CHECK(std::string(reinterpret_cast<const char*>(text.data())) == "DLPC350");
    std::array<std::uint8_t, 7> ports{};
    CHECK(libusb_get_port_numbers(libusb_get_device(handle), ports.data(), int(ports.size())) == 2);
    CHECK(ports[0] == 2);
    CHECK(ports[1] == 3);

    CHECK(libusb_kernel_driver_active(handle, 0) == 1);
    CHECK(libusb_claim_interface(handle, 0) == LIBUSB_ERROR_BUSY);
    CHECK(libusb_set_auto_detach_kernel_driver(handle, 1) == 0);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);

    int moved = 0;
    Report reply{};
    REQUIRE(send(handle, request({0xC0, 0x5A, 2, 0, 0x05, 0x02}), moved) == 0);
    REQUIRE(receive(handle, reply, moved) == 0);
    CHECK(moved == 64);
    CHECK(reply[0] == 0xC0);
    CHECK(reply[1] == 0x5A);
    CHECK(reply[2] == 16);
    CHECK(reply[7] == 4);  // major
    libusb_release_interface(handle, 0);
    libusb_close(handle);
}

TEST_CASE("usb: a silent projector is a timeout, a stalled one a pipe error until its halt is cleared") {
    if (bus() == nullptr) return;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-3", projector);
    const Libusb usb;
    libusb_device_handle* handle = usb.open(0x0451, 0x6401);
    REQUIRE(handle != nullptr);
    libusb_set_auto_detach_kernel_driver(handle, 1);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);
    const Report version = request({0xC0, 1, 2, 0, 0x05, 0x02});
    Report reply{};
    int moved = 0;

    bus()->locked([&](std::int64_t) { projector.setFaults({{Mishap::silence, 0, 1}}); });
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved, 50) == LIBUSB_ERROR_TIMEOUT);
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved) == 0);

    bus()->locked([&](std::int64_t) { projector.setFaults({{Mishap::stall, 0, 1}}); });
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved) == LIBUSB_ERROR_PIPE);
    CHECK(libusb_clear_halt(handle, 0x81) == 0);
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved) == 0);
    libusb_close(handle);
}

TEST_CASE("usb: pulled in the middle of a packet, the projector is gone for its program and back once plugged again") {
    if (bus() == nullptr) return;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-4", projector);
    const Libusb usb;
    libusb_device_handle* handle = usb.open(0x0451, 0x6401);
    REQUIRE(handle != nullptr);
    libusb_set_auto_detach_kernel_driver(handle, 1);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);
    bus()->locked([&](std::int64_t) { projector.setFaults({{Mishap::unplug, 100}}); });
    const Report version = request({0xC0, 1, 2, 0, 0x05, 0x02});
    Report reply{};
    int moved = 0;
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved) == 0);
    CHECK(send(handle, version, moved) == LIBUSB_ERROR_NO_DEVICE);
    libusb_close(handle);
    CHECK_FALSE(bus()->plugged("1-4"));

    bus()->locked([&](std::int64_t) { projector.setFaults({}); });
    REQUIRE(bus()->plug("1-4", projector));
    handle = usb.open(0x0451, 0x6401);
    REQUIRE(handle != nullptr);
    libusb_set_auto_detach_kernel_driver(handle, 1);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);
    CHECK(send(handle, version, moved) == 0);
    CHECK(receive(handle, reply, moved) == 0);
    libusb_close(handle);
}

TEST_CASE("usb: an interface another program holds is busy") {
    if (bus() == nullptr) return;
    EmulatedDaq daq;
    const Plugged plugged("1-5", daq);
    bus()->setBusy("1-5", true);
    const Libusb usb;
    libusb_device_handle* handle = usb.open(0x09DB, 0x00E8);
    REQUIRE(handle != nullptr);
    CHECK(libusb_claim_interface(handle, 0) == LIBUSB_ERROR_BUSY);
    bus()->setBusy("1-5", false);
    CHECK(libusb_claim_interface(handle, 0) == 0);
    libusb_device_handle* second = usb.open(0x09DB, 0x00E8);
    REQUIRE(second != nullptr);
    CHECK(libusb_claim_interface(second, 0) == LIBUSB_ERROR_BUSY);
    libusb_close(handle);  // without releasing it, as a program that was killed
    int claimed = LIBUSB_ERROR_BUSY;
    for (int i = 0; i < 500 && claimed == LIBUSB_ERROR_BUSY; ++i) {
        claimed = libusb_claim_interface(second, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    CHECK(claimed == 0);
    libusb_close(second);
}

TEST_CASE("usb: samples sent in bulk before and during a scan come out of the converter in order") {
    if (bus() == nullptr) return;
    EmulatedDaq daq;
    const Plugged plugged("1-6", daq);
    const Libusb usb;
    libusb_device_handle* handle = usb.open(0x09DB, 0x00E8);
    REQUIRE(handle != nullptr);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);

    constexpr int kFrames = 4800;  // a tenth of a second; the FIFO holds 2048
    std::vector<unsigned char> samples;
    for (int i = 0; i < kFrames; ++i)
        for (const int code : {i % 4096, 4095 - i % 4096}) {
            samples.push_back(static_cast<unsigned char>(code));
            samples.push_back(static_cast<unsigned char>(code >> 8));
        }
    int moved = 0;
    REQUIRE(libusb_bulk_transfer(handle, 0x02, samples.data(), 8192, &moved, 1000) == 0);
    CHECK(moved == 8192);
    std::array<unsigned char, 9> start = {kFrames & 255, kFrames >> 8, 0, 0, 1249 & 255, 1249 >> 8, 0, 0, 3};
    CHECK(libusb_control_transfer(handle, 0x40, 0x1A, 0, 0, start.data(), 9, 1000) == 9);
    CHECK(libusb_bulk_transfer(handle, 0x02, samples.data() + 8192, int(samples.size()) - 8192, &moved, 3000) == 0);
    CHECK(moved == int(samples.size()) - 8192);

    std::array<unsigned char, 2> status = {8, 0};
    for (int i = 0; i < 1000 && (status[0] & 8U) != 0; ++i)
        CHECK(libusb_control_transfer(handle, 0xC0, 0x44, 0, 0, status.data(), 2, 1000) == 2);
    CHECK((status[0] & 8U) == 0);
    CHECK(libusb_control_transfer(handle, 0xC0, 0x99, 0, 0, status.data(), 2, 1000) == LIBUSB_ERROR_PIPE);
    libusb_close(handle);

    std::vector<OutputSample> out;
    bus()->locked([&](std::int64_t now_ns) { out = daq.takeOutput(now_ns); });
    int next = 0;
    bool ordered = true;
    for (const OutputSample& sample : out) {
        if (!sample.joined) continue;
        ordered = ordered && sample.codes[0] == next % 4096 && sample.codes[1] == 4095 - next % 4096;
        ++next;
    }
    CHECK(ordered);
    CHECK(next == kFrames);
}

TEST_CASE("usb: what is no place, and a place that is taken, is refused") {
    if (bus() == nullptr) return;
    EmulatedLightCrafter projector, other;
    for (const char* path : {"", "1", "1-", "-2", "1-2-3", "1-2..3", "1.2", "a-b", "1-2."})
        CHECK_FALSE(bus()->plug(path, projector));
    const Plugged plugged("1-7", projector);
    CHECK_FALSE(bus()->plug("1-7", other));
    CHECK_FALSE(bus()->plug("1-7.1", other));
}

TEST_CASE("usb: a child process reads the projector's version" * doctest::skip()) {
    const Libusb usb;  // run by the test below, in a process of its own: the bus is its parent's
    libusb_device_handle* handle = usb.open(0x0451, 0x6401);
    REQUIRE(handle != nullptr);
    libusb_set_auto_detach_kernel_driver(handle, 1);
    REQUIRE(libusb_claim_interface(handle, 0) == 0);
    int moved = 0;
    Report reply{};
    for (int i = 0; i < 20; ++i) {
        REQUIRE(send(handle, request({0xC0, i, 2, 0, 0x05, 0x02}), moved) == 0);
        REQUIRE(receive(handle, reply, moved) == 0);
        REQUIRE(reply[1] == i);
        REQUIRE(reply[2] == 16);
    }
    libusb_close(handle);
}

TEST_CASE("usb: programs started from here see the bus too") {
    if (bus() == nullptr) return;
    EmulatedLightCrafter projector;
    const Plugged plugged("1-8", projector);
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const Ran ran = runProgram(self, "--no-skip '--test-case=usb: a child process*' 2>&1");
    CHECK_MESSAGE(ran.code == 0, ran.out);
    std::size_t messages = 0;
    bus()->locked([&](std::int64_t) { messages = projector.messages(); });
    CHECK(messages == 20);
}

TEST_CASE("usb: plugged and pulled again and again, the bus keeps no files open") {
    if (bus() == nullptr) return;
    const auto openFiles = [] {
        int count = 0;
        for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
            ++count;
        return count;
    };
    EmulatedLightCrafter projector;
    const Libusb usb;
    int before = 0;
    for (int i = 0; i < 30; ++i) {
        const Plugged plugged("1-9", projector);
        libusb_device_handle* handle = usb.open(0x0451, 0x6401);
        REQUIRE(handle != nullptr);
        libusb_close(handle);
        if (i == 0) before = openFiles();
    }
    // What was pulled is let go of a second later.
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (openFiles() > before + 4 && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(openFiles() <= before + 4);
}
