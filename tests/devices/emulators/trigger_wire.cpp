// Projector and converter joined by a wire: the converter's samples show each sweep's start where it was.
#include "devices/emulators/trigger_wire.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace ilf::devices::emulators;

TEST_CASE("trigger wire: sweeps of 59.94 Hz are seen where they began, though frames are told of late") {
    constexpr std::int64_t kMs = 1'000'000, kFrame = 16'683'350;
    LightCrafterOptions options;
    options.quirks.secondStart = false;
    EmulatedLightCrafter projector(options);
    EmulatedDaq daq;
    TriggerWire wire(projector);
    connect(daq, 2, wire, projector);
    std::int64_t now = 0;
    const auto write = [&](int cmd3, Bytes payload) {
        Bytes message = {0x40, 1, std::uint8_t(payload.size() + 2), 0, std::uint8_t(cmd3), 0x1A};
        message.insert(message.end(), payload.begin(), payload.end());
        message.resize(64);
        projector.out(0x01, message, now);
        Bytes reply(64);
        REQUIRE(projector.in(0x81, reply, now).answer == UsbAnswer::done);
        REQUIRE((reply[0] & 0x20) == 0);
        now += 100 * kMs;
    };
    projector.plugVideo({}, now);
    write(0x1B, {1});
    write(0x22, {0});
    write(0x23, {0});
    write(0x31, {0, 1, 0, 0});
    write(0x29, {0x10, 0x27, 0, 0, 0x10, 0x27, 0, 0});  // one slot of 10 ms
    write(0x33, {2});
    write(0x34, {1, 0x71, 4});
    write(0x33, {0});
    write(0x1A, {0});
    write(0x24, {2});
    REQUIRE(projector.running());

    // 48 kS/s of input 2 alone.
    Bytes start = {0, 0, 0, 0, 0, 0, 0, 0, 1249 & 255, 1249 >> 8, 0, 0, 0x04, 0};
    const ControlSetup setup{0x40, 0x11, 0, 0, 14};
    const std::int64_t began = now;
    REQUIRE(daq.control(setup, start, now).answer == UsbAnswer::done);
    std::vector<std::int64_t> syncs, rises;
    Bytes got;
    const auto fetch = [&] {
        Bytes room(4096);
        const UsbTransfer moved = daq.in(0x81, room, now);
        got.insert(got.end(), room.begin(), room.begin() + std::ptrdiff_t(moved.bytes));
    };
    std::int64_t next = now + 3 * kMs;
    for (int i = 0; i < 20; ++i, next += kFrame) {
        now = next + (i % 4) * kMs / 2;  // the converter is asked before the frame is told of, up to 1.5 ms late
        fetch();
        projector.verticalSync(nullptr, next);
        syncs.push_back(next);
        now = next + 8 * kMs;
        fetch();
    }
    bool high = false;
    for (std::size_t i = 0; i + 1 < got.size(); i += 2) {
        const double volt = (got[i] + 256 * got[i + 1]) * 20.0 / 4096.0 - 10.0;
        if (volt > 1.6 && !high) rises.push_back(began + std::llround(double(i / 2) * 1e9 / 48e3));
        high = volt > 1.6;
    }
    REQUIRE(rises.size() == syncs.size());
    for (std::size_t i = 0; i < rises.size(); ++i) {
        CHECK(rises[i] >= syncs[i]);
        CHECK(rises[i] - syncs[i] <= 20'834);  // a sample
    }
}
