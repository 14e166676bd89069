#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "devices/usb/usb_bus.h"
#include "tests/devices/usb/mock_usb.h"

using namespace ilf;
using namespace ilf::devices;
using ilf::devices::test::MockUsb;

namespace {

constexpr Milliseconds kLimit{2000};
constexpr std::array<UsbModel, 1> kModels{UsbModel{0x0451, 0x6401}};

/// Waits for what other threads do, at most ten seconds.
bool soon(const std::function<bool()>& condition) {
    for (int tries = 0; tries < 1000; ++tries) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string whyNot(const Result<std::unique_ptr<UsbLink>>& link) { return link ? "" : link.error().what; }

}  // namespace

TEST_CASE("usb: a device comes, is claimed, talked to, streamed to, and pulled out") {
    if (!MockUsb::preloaded()) {
        MESSAGE("SKIPPED: needs LD_PRELOAD=libumockdev-preload.so.0, as ctest sets it");
        return;
    }
    MockUsb device;
    auto bus = *UsbBus::open();
    device.plugIn();
    std::vector<UsbChange> changes;
    const auto news = [&] {
        for (const UsbChange& change : bus->changes())
            changes.push_back(change);
        return !changes.empty();
    };
    REQUIRE(soon(news));
    CHECK(changes.front().arrived);
    const auto found = bus->devices(kModels);
    REQUIRE(found->size() == 1);
    CHECK(found->front() == UsbIdentity{0x0451, 0x6401, "1-2", "DLPC350", ""});

    device.setBusy(true);
    CHECK(contains(whyNot(bus->link("1-2", 0)), "DLPC350 (0451:6401) at 1-2 is in use by "));
    device.setBusy(false);
    auto link = *bus->link("1-2", 0);
    CHECK(device.kernelDriverSentAway());
    const Endpoint out = *link->interruptOut(), in = *link->interruptIn();
    CHECK(out == Endpoint{0x01});
    CHECK(in == Endpoint{0x81});

    Bytes message(64);
    for (int i = 0; i < 20; ++i) {
        message[0] = static_cast<std::uint8_t>(i);
        REQUIRE(link->send(out, message, kLimit));
        REQUIRE(link->receive(in, 64, kLimit) == message);
    }
    CHECK(contains(link->receive(in, 64, Milliseconds(50)).error().what,
                   "did not answer in time when asked for data at endpoint 81. Unplug it"));
    REQUIRE(link->send(out, message, kLimit));  // and what comes after a time-out still comes
    CHECK(link->receive(in, 64, kLimit) == message);
    CHECK(link->controlIn({0x44, 0, 0}, 2, kLimit) == Bytes{0x08, 0x00});
    CHECK(link->controlOut({0x1A, 1, 2}, message, kLimit));
    CHECK(contains(link->controlIn({0x99, 0, 0}, 2, kLimit).error().what,
                   "refused (stalled) when handling request 99. Unplug it and plug it in again."));
    CHECK(contains(link->controlIn({0x99, 0, 0, "asked for its state"}, 2, kLimit).error().what,
                   "refused (stalled) when asked for its state."));
    CHECK(link->clearHalt({0x02}));

    {
        std::atomic<int> fills{0};
        const auto stream = *link->streamOut(*link->bulkOut(), 192, 4, [&](std::span<std::uint8_t>) { ++fills; });
        CHECK(soon([&] { return fills > 12; }));
        REQUIRE(link->send(out, message, kLimit));  // the rest of the device is not blocked
        CHECK(link->receive(in, 64, kLimit) == message);
        CHECK(stream->state());
        CHECK(device.swallowed() % 192 == 0);
        CHECK(device.inFlight() > 0);
    }
    CHECK(device.inFlight() == 0);  // cancelled and back
    {
        std::atomic<std::size_t> came{0};
        const auto stream =
            *link->streamIn(*link->bulkIn(), 64, 3, [&](std::span<const std::uint8_t> bytes) { came += bytes.size(); });
        CHECK(soon([&] { return came >= 50; }));
        CHECK(came % 10 == 0);
    }

    const auto stream = *link->streamOut(*link->bulkOut(), 192, 4, [](std::span<std::uint8_t>) {});
    device.pullOut();
    CHECK(soon([&] { return !stream->state(); }));
    CHECK(contains(stream->state().error().what, "is gone"));
    CHECK(contains(link->send(out, message, kLimit).error().what, "Plug it in again."));
    changes.clear();
    CHECK(soon(news));
    CHECK(!changes.front().arrived);
    CHECK(changes.front().device.path == "1-2");
    CHECK(bus->devices(kModels)->empty());
    bus.reset();  // links and streams may outlive it
}
