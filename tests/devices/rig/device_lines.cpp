// What the device panel reads of a LightCrafter's stage, in every state of its devices.
#include <doctest/doctest.h>

#include "tests/devices/rig/scripted_rig.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::ScriptedRig;

const Program kShow = test::program(1);

DeviceLine lineOf(const ScriptedRig& rig, const std::string& what) {
    for (const auto& line : rig.stage.report().devices)
        if (line.what == what) return line;
    FAIL("no line for " << what);
    return {};
}

void show(ScriptedRig& rig) {
    REQUIRE(rig.played(kShow));
    rig.room.now += 3s;
    REQUIRE(rig.stage.heartbeat());
}

}  // namespace

TEST_CASE("device lines: three, not looked for at first, then what each does") {
    ScriptedRig rig;
    for (const auto& line : rig.stage.report().devices) {
        CHECK(line.health == DeviceHealth::absent);
        CHECK(line.line == "It was not looked for yet.");
    }
    REQUIRE(rig.stage.heartbeat());
    CHECK(rig.stage.report().devices ==
          std::vector<DeviceLine>{
              {"projector", DeviceHealth::well, "board", "It shows steady white light; TAKE plays the slots."},
              {"display", DeviceHealth::well, "HDMI-2 (TI LCR4500 7)", "It carries white, 8x4 at 60.00 Hz."},
              {"lenses", DeviceHealth::well, "scripted lenses", "They rest at 0.00 D; TAKE plays the sweep."}});
    show(rig);
    CHECK(lineOf(rig, "projector").line == "It shows 16 slots a sweep.");
    CHECK(lineOf(rig, "display").line == "It carries the slots, 8x4 at 60.00 Hz.");
    CHECK(lineOf(rig, "lenses").line == "They sweep 0.00 to 2.27 D; phase within 0 us, +12 ppm, at 30.0 degrees C.");
}

TEST_CASE("device lines: without a sensor it is said that warming is not made up for") {
    ScriptedRig rig;
    rig.room.temperature_C.reset();
    show(rig);
    CHECK_FALSE(rig.stage.report().lensTemperature_C);
    CHECK(lineOf(rig, "lenses").line ==
          "They sweep 0.00 to 2.27 D; phase within 0 us, +12 ppm; their temperature is not measured, so what warming "
          "coils do to their powers is not made up for.");
}

TEST_CASE("device lines: a board pulled out is silent, then unplugged, and plain again once it is back") {
    ScriptedRig rig;
    show(rig);
    rig.room.boardGone = true;
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector").health == DeviceHealth::silent);
    rig.room.now += 1s;
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector") == DeviceLine{"projector", DeviceHealth::unplugged, "board", "There is no board."});
    CHECK(lineOf(rig, "lenses").health == DeviceHealth::well);
    rig.room.boardGone = false;
    rig.room.now += 1s;
    REQUIRE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector") ==
          DeviceLine{"projector", DeviceHealth::well, "board", "It shows steady white light; TAKE plays the slots."});
}

TEST_CASE("device lines: what was never there is absent, and says what its opener says") {
    ScriptedRig rig;
    rig.room.boardGone = rig.room.lensGone = true;
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector") ==
          DeviceLine{"projector", DeviceHealth::absent, "LightCrafter 4500", "There is no board."});
    CHECK(lineOf(rig, "lenses") ==
          DeviceLine{"lenses", DeviceHealth::absent, "USB-1208FS-Plus", "There are no lenses."});
}

TEST_CASE("device lines: no permission and in use are told with what would help, and are no absence") {
    ScriptedRig rig;
    rig.room.boardRefusal = Error{Fault::device, "No permission to open DLPC350 (0451:6401) at 1-2."};
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector") == DeviceLine{"projector", DeviceHealth::silent, "LightCrafter 4500",
                                                 "No permission to open DLPC350 (0451:6401) at 1-2."});
    CHECK(rig.room.whiteShown);  // all that can be reached is safe
    rig.room.boardRefusal.reset();
    rig.room.now += 1s;
    REQUIRE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector").health == DeviceHealth::well);
}

TEST_CASE("device lines: a board in another mode stays said until slots are lit again") {
    ScriptedRig rig;
    show(rig);
    rig.room.patterns = false;
    rig.room.troubles = {"It left pattern mode by itself."};
    REQUIRE_FALSE(rig.stage.heartbeat());
    const DeviceLine wrong{"projector", DeviceHealth::wrongMode, "board", "It left pattern mode by itself."};
    CHECK(lineOf(rig, "projector") == wrong);
    rig.room.troubles.clear();
    REQUIRE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "projector") == wrong);
    show(rig);
    CHECK(lineOf(rig, "projector").health == DeviceHealth::well);
}

TEST_CASE("device lines: a display that is pulled out or switched, and lenses out of step") {
    ScriptedRig rig;
    show(rig);
    rig.video->lose();
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "display") == DeviceLine{"display", DeviceHealth::unplugged, "HDMI-2 (TI LCR4500 7)",
                                               "The projector's display (HDMI-2) is gone. Check its cable and its "
                                               "power."});
    CHECK(lineOf(rig, "projector") ==
          DeviceLine{"projector", DeviceHealth::well, "board",
                     "It shows steady white light of its own, without video; TAKE plays the slots."});
    rig.video->giveBack();
    rig.room.now += 1s;
    REQUIRE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "display").health == DeviceHealth::well);
    rig.video->change({{16, 8}, 60.0_Hz});
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "display").health == DeviceHealth::wrongMode);
    rig.video->change({{8, 4}, 60.0_Hz});
    rig.room.now += 1s;
    REQUIRE_FALSE(rig.stage.heartbeat());  // switched again: white in that mode, too
    show(rig);
    CHECK(lineOf(rig, "display").health == DeviceHealth::well);
    rig.room.phaseError = 230.0_us;
    REQUIRE_FALSE(rig.stage.heartbeat());
    CHECK(lineOf(rig, "lenses").health == DeviceHealth::wrongMode);
    CHECK(lineOf(rig, "lenses").line == "Slots and lens were 0.23 ms apart; check the trigger cable, then TAKE.");
}

TEST_CASE("device lines: timing is told while slots are on, its missed triggers counted from then") {
    ScriptedRig rig;
    CHECK_FALSE(rig.stage.report().timing);
    rig.room.missing = 7;  // while it was aligned
    rig.room.jitter = 3.0_us;
    show(rig);
    rig.room.missing = 9;
    rig.room.phaseError = 21.0_us;
    REQUIRE(rig.stage.heartbeat());
    const auto report = rig.stage.report();
    REQUIRE(report.timing);
    CHECK(*report.timing == StageTiming{true, 21.0_us, 3.0_us, 12.0, 2});
    CHECK(report.lensTemperature_C == 30.0);
    rig.stage.safeLight();
    CHECK_FALSE(rig.stage.report().timing);
}

TEST_CASE(
    "device lines: a display without a name or a measured rate is said to be so, and slots have the plan's rate") {
    ScriptedRig rig;
    struct Unmeasured : test::ScriptedVideo {
        using ScriptedVideo::ScriptedVideo;
        Result<VideoMode> mode() override { return VideoMode{{8, 4}, 0.0_Hz}; }
        const DisplayIdentity& display() const override { return screen; }
        DisplayIdentity screen{"screen", "", "", ""};
    };
    auto made = rig.made();
    made.video = std::make_shared<Unmeasured>(rig.room);
    LightCrafterStage stage(std::move(made));
    REQUIRE(stage.load(kShow));
    REQUIRE(stage.swap());
    const auto report = stage.report();
    CHECK(report.projectorLine == "board: 16 slots at 60.00 Hz");
    CHECK(report.devices[1] == DeviceLine{"display", DeviceHealth::well, "screen (unnamed)",
                                          "It carries the slots, 8x4; how often a second is not measured."});
}

TEST_CASE("device lines: an emulated rig says so") {
    ScriptedRig rig;
    CHECK_FALSE(rig.stage.report().emulated);
    CHECK_FALSE(rig.stage.report().simulated);
    auto made = rig.made();
    made.emulated = true;
    const LightCrafterStage emulated(std::move(made));
    CHECK(emulated.report().emulated);
    CHECK(emulated.report().simulated);
}

}  // namespace ilf::devices
