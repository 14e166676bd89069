// What befalls an emulated rig, as its stage and whoever looks at its light notice it: in real time, over libusb and an
// X server. Needs libumockdev-preload.so.0 in LD_PRELOAD, as ctest sets it, and Xvfb; says so where one is missing.
#include <doctest/doctest.h>

#include <algorithm>

#include "core/lens/waveform.h"
#include "devices/rig/video_output.h"
#include "devices/video/display_output.h"
#include "tests/devices/emulated_rig/running_rig.h"
#include "tests/devices/endtoend/bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using namespace std::chrono_literals;

namespace {

Program playing() {
    Program program = sweepOf(6, 80);
    program.waveform = idealSine(0.5_D, -2.0_D, 3.0_D, 60.0_Hz, 0.0_s);
    program.waveform.unit = DriveUnit::ampere;
    program.waveform.drive.c = {0.0, 0.1};
    program.projectorDelay = {};
    return program;
}

template <class Holds>
bool soon(Holds holds) {
    const auto until = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < until) {
        if (holds()) return true;
        std::this_thread::sleep_for(20ms);
    }
    return false;
}

/// One picture for all of a sweep, full light, as video.
bool steadyWhite(DeviceClient& client) {
    Received received;
    const auto sweep = receivedSweep(client, received);
    return !received.patterns && sweep.size() == 1 && received.exposures[0].video &&
           std::ranges::all_of(sweep[0].light.pixels(), [](std::uint8_t value) { return value == 255; });
}

bool atRest(DeviceClient& client) {
    const auto received = client.readReceived();
    if (!received) return false;
    const auto [low, high] = std::ranges::minmax(received->left);
    return high - low < 0.02_D && received->most_mA[0] < 1.0;
}

}  // namespace

TEST_CASE("emulated rig: switched on it gives white video and rests; each cable can be pulled and put back") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    CHECK(soon([&] { return steadyWhite(rig.client()); }));
    CHECK(atRest(rig.client()));
    const auto state = rig.client().readState();
    REQUIRE(state);
    CHECK(state->light == LightMode::steady);
    CHECK(state->lens == LensMode::rest);
    CHECK(state->lensName == "emulated lens, preset datasheet");

    const auto bus = UsbBus::open();
    const UsbModel models[] = {{0x0451, 0x6401}, {0x09DB, 0x00E8}};
    const auto attached = [&] { return (*bus)->devices(models)->size(); };
    CHECK(soon([&] { return attached() == 2; }));
    for (const char* device : {"projector", "lenses"}) {
        CHECK(rig.befalls(device, "unplug"));
        CHECK(soon([&] { return attached() == 1; }));
        CHECK(rig.befalls(device, "plug"));
        CHECK(soon([&] { return attached() == 2; }));
    }

    const auto video = *displayOutput({{}, {912, 1140}});
    REQUIRE(video->show(uniformFrame({912, 1140}, 255)));
    CHECK(rig.befalls("display", "unplug"));
    CHECK(soon([&] { return !video->mode(); }));
    CHECK(rig.client().readReceived()->exposures.empty());
    CHECK(rig.befalls("display", "plug"));
    CHECK(soon([&] { return video->show(uniformFrame({912, 1140}, 255)).has_value(); }));
    CHECK(soon([&] { return steadyWhite(rig.client()); }));

    // What only cables may tell, and what is no mishap.
    const auto order = rig.client().call(SteadyLight{});
    REQUIRE(order);
    CHECK(std::holds_alternative<Refused>(*order));
    CHECK_FALSE(rig.client().mishap({"toaster", "unplug", 0, 0, 0.0}));
    CHECK_FALSE(rig.client().mishap({"projector", "boredom", 0, 0, 0.0}));
    CHECK_FALSE(rig.client().readExposure(99));
}

TEST_CASE("emulated rig: whatever is pulled or fails during a show, light ends white and the lenses at rest") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    const auto stage = rig.stage(4);
    struct Case {
        std::string device, kind, mends;
    };
    for (const auto& [device, kind, mends] :
         {Case{"display", "unplug", "plug"}, Case{"lenses", "underrun", "none"}, Case{"lenses", "unplug", "plug"},
          Case{"projector", "wrong-mode", "none"}}) {
        CAPTURE(device);
        CAPTURE(kind);
        REQUIRE(stage->load(playing()));
        const auto swapped = stage->swap();
        if (!swapped) FAIL(swapped.error().what);
        REQUIRE(rig.befalls(device, kind));
        const auto trouble = playedFor(*stage, 4s);
        REQUIRE(trouble);
        MESSAGE(device, ", ", kind, ": ", *trouble);
        // Without any video: the board's own white.
        if (device == "display") CHECK(soon([&] { return steadyWhite(rig.client()) && atRest(rig.client()); }));
        REQUIRE(rig.befalls(device, mends));
        CHECK(soon([&] {
            (void)stage->heartbeat();
            return steadyWhite(rig.client()) && atRest(rig.client());
        }));
    }
}
