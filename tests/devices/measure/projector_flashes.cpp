// The projector's edge pattern: flashes while it is measured, steady white before and after, whatever fails.
#include "devices/measure/projector_flashes.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/devices/rig/scripted_rig.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::test;

namespace {

struct Flashing {
    ScriptedRoom room;
    std::shared_ptr<ScriptedVideo> video = std::make_shared<ScriptedVideo>(room);
    Program packed;

    LightCrafterRig rig() {
        LightCrafterRig rig;
        rig.openProjector = [this]() -> Result<std::unique_ptr<StageProjector>> {
            if (room.boardRefusal) return tl::unexpected(*room.boardRefusal);
            return std::make_unique<ScriptedBoard>(room);
        };
        rig.openLens = [](Dioptre) -> Result<std::unique_ptr<StageLens>> {
            return fail(Fault::device, "The measurement holds the lenses.");
        };
        rig.video = video;
        rig.packed = [this](const Program& program) -> Result<PatternFrame> {
            packed = program;
            PatternFrame frame;
            frame.picture = uniformFrame(program.projector, 1);
            frame.sequence.entries.resize(program.imageOfSlot.size());
            return frame;
        };
        rig.clock = room.clock();
        return rig;
    }
};

}  // namespace

TEST_CASE("flashes light the first slot of each sweep, and end in steady white light") {
    Flashing f;
    // What a lens at rest must not see is what is measured here, and nobody wears one.
    f.room.wave.emplace();
    ProjectorFlashes flashes(f.rig(), {{8, 4}, 60.0_Hz, 360.0_Hz});
    CHECK(f.room.log.empty());
    const auto on = flashes.flash(true);
    REQUIRE_MESSAGE(on, on.error().what);
    REQUIRE(f.packed.imageOfSlot.size() == 6);
    CHECK(f.packed.imageOfSlot[0] == 0);
    CHECK(std::count(f.packed.imageOfSlot.begin(), f.packed.imageOfSlot.end(), Program::kDark) == 5);
    CHECK(f.packed.images[0].at(7, 3) == 255);
    CHECK(f.room.slotted());
    REQUIRE(flashes.flash(false));
    CHECK_FALSE(f.room.slotted());
    CHECK(f.room.whiteShown);
}

TEST_CASE("whatever fails on the way to flashes, the light is steady after") {
    std::size_t calls = 0;
    {
        Flashing f;
        f.room.wave.emplace();
        ProjectorFlashes flashes(f.rig(), {{8, 4}, 60.0_Hz, 360.0_Hz});
        REQUIRE(flashes.flash(true));
        calls = f.room.log.size();
    }
    for (std::size_t n = 1; n <= calls; ++n) {
        CAPTURE(n);
        Flashing f;
        f.room.wave.emplace();
        std::size_t count = 0;
        f.room.failsAt = [&](const std::string&) { return ++count == n; };
        ProjectorFlashes flashes(f.rig(), {{8, 4}, 60.0_Hz, 360.0_Hz});
        CHECK_FALSE(flashes.flash(true));
        REQUIRE(flashes.flash(false));
        CHECK_FALSE(f.room.slotted());
    }
    Flashing f;
    f.room.boardRefusal = Error{Fault::device, "There is no LightCrafter 4500."};
    ProjectorFlashes flashes(f.rig(), {{8, 4}, 60.0_Hz, 360.0_Hz});
    const auto on = flashes.flash(true);
    REQUIRE_FALSE(on);
    CHECK(on.error().what.find("no LightCrafter") != std::string::npos);
}
