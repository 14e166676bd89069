#include <doctest/doctest.h>

#include "tests/devices/rig/scripted_rig.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::ScriptedRig;
using Calls = std::vector<std::string>;

Program slower(std::uint32_t seed) {
    auto program = test::program(seed);
    program.slotRate = 480.0_Hz;
    program.imageOfSlot.resize(8);
    return program;
}

Result<void> evening(ScriptedRig& rig) {
    return test::eveningOf(rig,
                           {test::program(1), test::dabbed(test::program(1), 9), test::program(2, 4.27_D), slower(3)});
}

/// A show whose display is pulled and put back, and that goes on.
Result<void> lostAndBack(ScriptedRig& rig) {
    if (const auto shown = rig.played(test::program(1)); !shown) return shown;
    rig.room.now += 3s;
    rig.video->lose();
    for (int beat = 0; beat < 12; ++beat) {
        (void)rig.stage.heartbeat();
        rig.stage.safeLight();
        rig.room.now += 100ms;
    }
    rig.video->giveBack();
    rig.room.now += 1s;
    if (const auto well = rig.stage.heartbeat(); !well) return well;
    if (const auto shown = rig.played(test::program(2, 4.27_D)); !shown) return shown;
    rig.stage.safeLight();
    return rig.stage.heartbeat();
}

}  // namespace

TEST_CASE("lightcrafter stage: whichever call fails, at whichever time, the scene is lit and the lens rests") {
    test::eachCallFails<ScriptedRig>(evening, test::program(5), 80);
}

TEST_CASE("lightcrafter stage: whichever call fails around a lost display, the scene is lit and the lens rests") {
    test::eachCallFails<ScriptedRig>(lostAndBack, test::program(5), 60,
                                     [](ScriptedRig& rig) { rig.video->giveBack(); });
}

TEST_CASE("lightcrafter stage: what fails for good from any call on is left, and all others are made safe") {
    for (const std::string gone : {"video", "board", "lens"}) {
        bool untouched = false;
        for (int failing = 1; !untouched; ++failing) {
            REQUIRE(failing < 300);
            CAPTURE(gone);
            CAPTURE(failing);
            int calls = 0;
            bool failed = false;
            ScriptedRig rig;
            rig.room.failsAt = [&](const std::string& call) {
                if (!call.starts_with(gone) || ++calls < failing) return false;
                failed = true;
                rig.room.boardGone = gone == "board";
                rig.room.lensGone = gone == "lens";
                if (gone == "video") rig.video->lose();
                return true;
            };
            const auto done = evening(rig);
            untouched = !failed;
            if (untouched) break;
            rig.stage.safeLight();
            for (int beat = 0; beat < 30; ++beat) {
                rig.room.now += 100ms;
                CHECK_FALSE(rig.stage.heartbeat());
                rig.stage.safeLight();
            }
            CHECK_FALSE(rig.room.slotted());
            if (gone != "video") CHECK(rig.room.whiteShown);
            if (gone == "video") CHECK(rig.room.ownWhite);
            if (gone != "board") CHECK_FALSE(rig.room.patterns);
            if (gone != "lens") CHECK_FALSE(rig.room.wave);
            CHECK_FALSE(rig.stage.report().well);
            CHECK(rig.room.violations == Calls{});
        }
    }
}

TEST_CASE("lightcrafter stage: when neither display nor board listen, the lens is still told, and it is said") {
    ScriptedRig rig;
    REQUIRE(rig.played(test::program(1)));
    rig.video->lose();
    rig.room.boardGone = true;
    const auto beat = rig.stage.heartbeat();
    REQUIRE_FALSE(beat);
    CHECK(beat.error().what.find("The projector's light is not known.") != std::string::npos);
    CHECK_FALSE(rig.room.wave);
    CHECK(rig.stage.report().projectorLine == "LightCrafter 4500: no answer; its light is not known");
    CHECK_FALSE(rig.stage.report().well);
}

TEST_CASE(
    "lightcrafter stage: whatever is asked and whatever fails, slots never meet a resting lens or a rate's change") {
    law("light and lens", [] {
        ScriptedRig rig;
        const auto failRate = *rc::gen::element(0, 5, 20);
        rig.room.failsAfterEffect = *rc::gen::arbitrary<bool>();
        const auto chances = *rc::gen::container<std::vector<int>>(64, rc::gen::inRange(0, 100));
        // By value: the stage makes safe light when it goes, after all of these.
        rig.room.failsAt = [chances, failRate, asked = std::size_t{0}](const std::string&) mutable {
            return chances[asked++ % chances.size()] < failRate;
        };
        const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 14));
        bool faulted = false, lost = false;
        for (const int step : steps) {
            switch (step) {
            case 0:
            case 1:
            case 2:
            case 3: {
                const auto program = step < 2   ? test::program(static_cast<std::uint32_t>(step) + 1)
                                     : step < 3 ? test::program(2, 4.0_D)
                                                : slower(3);
                faulted = !rig.played(program);
                break;
            }
            case 4:
                rig.stage.safeLight();
                faulted = true;  // as a fault: slots need a new swap
                break;
            case 5:
                rig.room.boardGone = !rig.room.boardGone;
                break;
            case 6:
                rig.room.phaseError = rig.room.phaseError > 0.0_s ? 0.0_s : 300.0_us;
                break;
            case 7:
                lost = !lost;
                lost ? rig.video->lose() : rig.video->giveBack();
                break;
            case 8:
                rig.room.seesVideo = !rig.room.seesVideo;
                break;
            default:
                rig.room.now += std::chrono::milliseconds(step * 300);
                if (!rig.stage.heartbeat()) {
                    rig.stage.safeLight();
                    faulted = true;
                }
                // Display or none, video or none: a board that listens is lit.
                if (faulted && !rig.room.plainFailed && !rig.room.boardGone) RC_ASSERT(rig.room.lit());
            }
            RC_ASSERT(rig.room.violations.empty());
            const bool reachable = !rig.room.whiteFailed || !rig.room.plainFailed;
            RC_ASSERT(!faulted || !rig.room.slotted() || !reachable);
        }
    });
}

}  // namespace ilf::devices
