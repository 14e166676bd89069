// A lens box of an emulated rig that does not listen for good, and lenses that get warm: what is read, and where light
// and lenses end, in real time. Needs libumockdev-preload.so.0 in LD_PRELOAD, as ctest sets it, and Xvfb; says so where
// one is missing.
#include <doctest/doctest.h>

#include "tests/devices/emulated_rig/rig_faults.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using namespace std::chrono_literals;

TEST_CASE("emulated rig: a lens box that refuses for good is brought to rest by its samples, below white light") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    const auto stage = rig.stage(4);
    const std::string read = readAt(rig, *stage, {"lenses", "nack", 0, 0, 0.0}, "refused (stalled)");
    CHECK_MESSAGE(contains(read,
                           "USB-1208FS-Plus (09db:00e8) at 1-3 refused (stalled) when asked for its state. Unplug "
                           "it and plug it in again."),
                  read);
    CHECK_FALSE(contains(read, "Where the lens is"));
    CHECK(soon([&] { return steadyWhite(rig.client()) && atRest(rig.client()); }));
    // Asked again and again it still refuses, and they stay.
    for (int i = 0; i < 8; ++i) {
        CHECK_FALSE(stage->heartbeat());
        CHECK(atRest(rig.client()));
        std::this_thread::sleep_for(100ms);
    }
    CHECK(lineOf(*stage, "lenses").health == DeviceHealth::silent);
    CHECK(steadyWhite(rig.client()));
    REQUIRE(rig.befalls("lenses", "none"));
    CHECK(soon([&] { return stage->heartbeat().has_value(); }));
    CHECK(atRest(rig.client()));
}

TEST_CASE("emulated rig: a lens box that is silent for good holds the lenses until it answers, below white light") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    const auto stage = rig.stage(4);
    const std::string read = readAt(rig, *stage, {"lenses", "silence", 0, 0, 0.0}, "did not answer in time");
    CHECK_MESSAGE(contains(read, "USB-1208FS-Plus (09db:00e8) at 1-3 did not answer in time when "), read);
    CHECK(contains(read, "Unplug it and plug it in again."));
    CHECK(contains(read, "Where the lens is, is not known."));
    CHECK(soon([&] { return steadyWhite(rig.client()); }));
    CHECK(soon([&] { return still(*rig.client().readReceived()); }));
    const auto held = *rig.client().readReceived();
    MESSAGE("held at ", held.left[0].si(), " D, by ", held.most_mA[0], " mA");
    CHECK_FALSE(stage->heartbeat());
    CHECK(rig.client().readReceived()->most_mA == held.most_mA);

    SUBCASE("it answers: they rest") {
        REQUIRE(rig.befalls("lenses", "none"));
        CHECK(soon([&] { return stage->heartbeat().has_value(); }));
        CHECK(soon([&] { return atRest(rig.client()); }));
        CHECK(steadyWhite(rig.client()));
    }
    SUBCASE("its cable is pulled: without power no current flows") {
        REQUIRE(rig.befalls("lenses", "unplug"));
        CHECK(soon([&] { return atRest(rig.client()); }));
        CHECK(steadyWhite(rig.client()));
    }
}

TEST_CASE("emulated rig: lenses that get warm are not noticed by a box without a sensor, which the panel says") {
    RunningRig rig;
    if (rig.refused()) {
        MESSAGE("SKIPPED: ", *rig.refused());
        return;
    }
    const auto stage = rig.stage(4);
    const double before_C = rig.client().readReceived()->temperature_C[0];
    for (int tries = 1; tries <= kTries; ++tries) {
        const auto shown = played(*stage, shownOnRig());
        if (!shown) FAIL(shown.error().what);
        REQUIRE(rig.befalls("lenses", "over-temperature", 0, 0, 8.0));
        CHECK(rig.client().readReceived()->temperature_C[0] > before_C + 6.0);
        const auto trouble = playedFor(*stage, 2s);
        if (trouble && tries < kTries) {  // a busy machine
            MESSAGE("taken again: ", *trouble);
            REQUIRE(rig.befalls("lenses", "none"));
            continue;
        }
        CHECK_MESSAGE(!trouble, trouble.value_or(""));
        break;
    }
    CHECK(stage->report().light == LightMode::slotted);
    CHECK(lineOf(*stage, "lenses").health == DeviceHealth::well);
    CHECK(contains(lineOf(*stage, "lenses").line, "their temperature is not measured"));
    CHECK_FALSE(stage->report().lensTemperature_C);
}
