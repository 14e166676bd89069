#include "devices/rig/any_projector_stage.h"

#include <doctest/doctest.h>

#include "devices/rig/memory_video_output.h"
#include "tests/devices/programs.h"

namespace ilf::devices {
namespace {

struct Rehearsal {
    std::chrono::nanoseconds now{std::chrono::seconds(1)};
    std::shared_ptr<MemoryVideoOutput> video = std::make_shared<MemoryVideoOutput>(
        VideoMode{{200, 130}, 60.0_Hz},
        Clock{[this] { return now; }, [this](std::chrono::nanoseconds time) { now += time; }},
        DisplayIdentity{"HDMI-2", "", "", ""});

    std::unique_ptr<AnyProjectorStage> stage(RehearsedLight shown = {}) {
        return *AnyProjectorStage::open(video, StagePurpose::rehearsal, shown);
    }
};

/// Two images, each uniform: 255 in a quarter of the slots, 51 in another one.
Program halves() {
    auto program = test::program(1);
    program.images = {LightImage({200, 130}, 255), LightImage({200, 130}, 51)};
    program.imageOfSlot = {0, 1, -1, -1};
    program.slotRate = 240.0_Hz;
    return program;
}

}  // namespace

TEST_CASE("any projector: refused for shows, with the reason") {
    Rehearsal room;
    const auto stage = AnyProjectorStage::open(room.video, StagePurpose::show);
    REQUIRE_FALSE(stage);
    CHECK(stage.error().fault == Fault::unsupported);
    CHECK(stage.error().what.find("no slots in time") != std::string::npos);
}

TEST_CASE("any projector: one slot's light, or the mix of all, as sRGB codes") {
    Rehearsal room;
    const auto one = room.stage({0});
    REQUIRE(one->load(halves()));
    REQUIRE(one->swap());
    CHECK(room.video->shown().at(7, 7, 1) == 255);
    CHECK(one->report().light == LightMode::steady);
    CHECK(one->report().projectorLine == "projector on HDMI-2: rehearsal, slot 0; not in time, so nothing is blurred");

    const auto mix = room.stage();
    REQUIRE(mix->load(halves()));
    REQUIRE(mix->swap());
    // (1 + 0.2 + 0 + 0) / 4 = 0.3 of the light is code 149 (sRGB: 0.5838).
    CHECK(room.video->shown().at(199, 129, 2) == 149);
}

TEST_CASE("any projector: what does not fit is refused and changes nothing") {
    Rehearsal room;
    const auto stage = room.stage({9});
    CHECK(stage->load(halves()).error().what == "The sweep has no slot 9; its slots count 0 to 3.");
    CHECK(stage->load(test::program(1, 2.0_D, {64, 64})).error().what ==
          "The program is for 64x64 pixels, the display has 200x130; set the rig's projector to that.");
    CHECK_FALSE(stage->swap());
    CHECK(room.video->framesShown() == 0);
}

TEST_CASE("any projector: safe light is white; a lost display is said, and white again once it is back") {
    Rehearsal room;
    const auto stage = room.stage();
    REQUIRE(stage->load(halves()));
    REQUIRE(stage->swap());
    stage->safeLight();
    CHECK(room.video->shown() == uniformFrame({200, 130}, 255));
    room.video->lose();
    CHECK(stage->heartbeat().error().what ==
          "The projector's display (HDMI-2) is gone. Check its cable and its power.");
    CHECK(stage->report().projectorLine == "projector on HDMI-2: its light is not known");
    CHECK_FALSE(stage->report().well);
    room.video->giveBack();
    REQUIRE(stage->heartbeat());
    CHECK(room.video->shown() == uniformFrame({200, 130}, 255));
    CHECK(stage->report().well);
    CHECK_FALSE(stage->swap());  // what was loaded before the loss is not lit by itself
}

TEST_CASE("any projector: it leaves white light behind") {
    Rehearsal room;
    auto stage = room.stage();
    REQUIRE(stage->load(halves()));
    REQUIRE(stage->swap());
    stage.reset();
    CHECK(room.video->shown() == uniformFrame({200, 130}, 255));
}

TEST_CASE("any projector: one line for its display, whatever happens to it") {
    Rehearsal room;
    const auto stage = room.stage({0});
    const auto line = [&] {
        const auto lines = stage->report().devices;
        REQUIRE(lines.size() == 1);
        return lines.front();
    };
    const std::string name = "projector on HDMI-2";
    CHECK(line() == DeviceLine{"display", DeviceHealth::absent, name, "It was not looked for yet."});
    REQUIRE(stage->heartbeat());
    CHECK(line() ==
          DeviceLine{"display", DeviceHealth::well, name, "It shows steady white light; TAKE shows the rehearsal."});
    REQUIRE(stage->load(halves()));
    REQUIRE(stage->swap());
    CHECK(line() ==
          DeviceLine{"display", DeviceHealth::well, name, "It shows slot 0, not in time: nothing is blurred."});
    room.video->lose();
    REQUIRE_FALSE(stage->heartbeat());
    CHECK(line() == DeviceLine{"display", DeviceHealth::unplugged, name,
                               "The projector's display (HDMI-2) is gone. Check its cable and its power."});
}

}  // namespace ilf::devices
