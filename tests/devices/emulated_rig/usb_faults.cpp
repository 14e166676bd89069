// What befalls an emulated rig, as its stage and whoever looks at its light notice it: in real time, over libusb and an
// X server. Needs libumockdev-preload.so.0 in LD_PRELOAD, as ctest sets it, and Xvfb; says so where one is missing.
#include <doctest/doctest.h>

#include "devices/rig/video_output.h"
#include "devices/video/display_output.h"
#include "tests/devices/emulated_rig/rig_faults.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using namespace std::chrono_literals;

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
        REQUIRE(stage->load(shownOnRig()));
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

TEST_CASE("emulated rig: a projector that refuses or is silent for good is white in all its slots, lenses at rest") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    for (const auto& [kind, words] :
         {std::pair("nack", "refused to tell its"), std::pair("silence", "did not answer")}) {
        CAPTURE(kind);
        const auto stage = rig.stage(4);
        const std::string read = readAt(rig, *stage, {"projector", kind, 0, 0, 0.0}, words);
        CHECK_MESSAGE(contains(read, words), read);
        CHECK(contains(read, "The LightCrafter 4500 at 1-2"));
        CHECK(contains(read, "The projector's light is not known."));
        CHECK(soon([&] { return whiteInEverySlot(rig.client()) && atRest(rig.client()); }));
        CHECK(lineOf(*stage, "projector").health == DeviceHealth::silent);
        REQUIRE(rig.befalls("projector", "none"));
        CHECK(soon([&] {
            (void)stage->heartbeat();
            return steadyWhite(rig.client()) && atRest(rig.client());
        }));
    }
}

TEST_CASE(
    "emulated rig: a picture that stays is told by no cable, only by the light, and ends in white when it is let go") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    const auto stage = rig.stage(4);
    const auto shows = [&](const Program& program) {
        Received received;
        return compared(intendedSweep(program, 4), receivedSweep(rig.client(), received)).same();
    };
    const Program first = shownOnRig(80), second = shownOnRig(81);
    for (int tries = 0; tries < kTries; ++tries) {
        REQUIRE(played(*stage, first));
        REQUIRE(soon([&] { return shows(first); }));
        REQUIRE(rig.befalls("projector", "stuck-frame"));
        REQUIRE(stage->load(second));
        const auto swapped = stage->swap();
        const auto from = rig.client().readReceived()->frames;
        std::optional<std::string> trouble = swapped ? std::nullopt : std::optional(swapped.error().what);
        while (!trouble && rig.client().readReceived()->frames < from + 60)
            trouble = playedFor(*stage, 100ms);
        if (trouble && tries + 1 < kTries) {  // a busy machine
            MESSAGE("taken again: ", *trouble);
            REQUIRE(rig.befalls("projector", "none"));
            continue;
        }
        CHECK_MESSAGE(!trouble, trouble.value_or(""));
        break;
    }
    CHECK(shows(first));
    CHECK_FALSE(shows(second));
    CHECK(stage->report().light == LightMode::slotted);
    // Safe light is the display's white, as video, which a board that holds its picture does not show either.
    stage->safeLight();
    const auto video = [&] {
        (void)stage->heartbeat();
        const auto received = rig.client().readReceived();
        return received && !received->patterns && received->exposures.size() == 1 && atRest(rig.client());
    };
    CHECK(soon(video));
    CHECK_FALSE(steadyWhite(rig.client()));
    REQUIRE(rig.befalls("projector", "none"));
    CHECK(soon([&] { return video() && steadyWhite(rig.client()); }));
}
