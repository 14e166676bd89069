#include <doctest/doctest.h>

#include <algorithm>
#include <new>

#include "devices/simulated/simulated_stage.h"
#include "tests/devices/rig/scripted_rig.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::ScriptedRig;
using Calls = std::vector<std::string>;

const Program kFirst = test::program(1);

Program slower() {
    auto program = test::program(3);
    program.slotRate = 480.0_Hz;
    program.imageOfSlot.resize(8);
    return program;
}

bool safe(const ScriptedRig& rig) { return !rig.room.slotted() && rig.room.whiteShown && !rig.room.wave; }

/// What a show's heartbeat says at the fault, which must have ended in safe light.
std::string faultOf(ScriptedRig& rig) {
    const auto beat = rig.stage.heartbeat();
    CHECK(rig.room.violations == Calls{});
    CHECK_FALSE(rig.room.slotted());
    return beat ? "nothing" : beat.error().what;
}

}  // namespace

TEST_CASE("lightcrafter stage: a start is white video, the sweep, the patterns, then the program's frame") {
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    CHECK(rig.orders() == Calls{"lens: opened at 0.0", "video: white", "lens: safe", "board: video", "lens: play",
                                "board: start 16", "video: frame"});
    CHECK(rig.room.slotted());
    CHECK(rig.stage.report().light == LightMode::slotted);
    CHECK(rig.stage.report().well);
    CHECK(rig.room.violations == Calls{});

    rig.stage.safeLight();
    CHECK(rig.orders() == Calls{"video: white", "lens: safe", "board: video"});
    CHECK(safe(rig));
    CHECK(rig.stage.report().projectorLine == "board: steady white");
    CHECK(rig.stage.report().lens == LensMode::rest);
    REQUIRE(rig.stage.heartbeat());
}

TEST_CASE("lightcrafter stage: the same wave is one frame of video, whose light begins a frame later") {
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    rig.orders();
    REQUIRE(rig.stage.load(test::program(2)));
    const auto loaded = rig.room.now;
    REQUIRE(rig.stage.swap());
    CHECK(rig.orders() == Calls{"video: frame"});
    const auto first = rig.stage.lightBegan() - loaded;
    CHECK(first <= 2 * 16'666'668ns);  // one sweep and one frame
    CHECK(first > 16'666'666ns);
    CHECK(rig.room.now >= rig.stage.lightBegan());
}

TEST_CASE("lightcrafter stage: another wave goes through white, another rate through a fresh start of the patterns") {
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    rig.orders();
    REQUIRE(rig.played(test::program(2, 5.0_D)));
    CHECK(rig.orders() == Calls{"video: white", "lens: play", "video: frame"});
    auto later = test::program(2, 5.0_D);
    later.projectorDelay = 0.6_ms;
    REQUIRE(rig.played(later));
    CHECK(rig.orders() == Calls{"video: white", "lens: play", "video: frame"});
    REQUIRE(rig.played(slower()));
    CHECK(rig.orders() == Calls{"video: white", "lens: play", "board: start 8", "video: frame"});
    CHECK(rig.room.violations == Calls{});
}

TEST_CASE("lightcrafter stage: slots wait until the lens is predicted to be settled") {
    std::chrono::nanoseconds told{0}, lit{0};
    ScriptedRig rig;
    rig.room.failsAt = [&](const std::string& call) {
        if (call == "lens: play") told = rig.room.now;
        if (call == "video: frame") lit = rig.room.now;
        return false;
    };
    REQUIRE(rig.played(kFirst));
    // 60 ms until it plays alone, then ln(missing / 0.05 D) time constants of the lens.
    const double settling = kLensTimeConstant.si() * std::log(2.27 / kSettledLens.si());
    CHECK(std::chrono::duration<double>(lit - told).count() >= 0.06 + settling);
}

TEST_CASE("lightcrafter stage: a wearer who rests elsewhere gets lenses that rest there") {
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    rig.orders();
    auto program = test::program(1);
    program.waveform = idealSine(1.5_D, 1.5_D, 3.0_D, 60.0_Hz, 0.0_s);
    REQUIRE(rig.played(program));
    CHECK(rig.orders() == Calls{"video: white", "lens: safe", "lens: opened at 1.5", "video: white", "lens: safe",
                                "board: video", "lens: play", "board: start 16", "video: frame"});
    rig.stage.safeLight();
    CHECK(rig.stage.report().lensPower == 1.5_D);
    CHECK(rig.room.violations == Calls{});
}

TEST_CASE("lightcrafter stage: a stage that has told nothing yet makes safe whatever an earlier one left on") {
    ScriptedRig rig;
    rig.room.patterns = rig.room.frameShown = true;
    rig.room.wave = kFirst.waveform;
    rig.stage.safeLight();
    CHECK(safe(rig));

    ScriptedRig other;
    other.room.ownWhite = true;  // of a player that lost its display and was killed
    other.stage.safeLight();
    CHECK(safe(other));
    CHECK_FALSE(other.room.ownWhite);
    CHECK(other.played(kFirst));
}

TEST_CASE("lightcrafter stage: every fault of a show ends in safe light, with one sentence") {
    const auto show = [](ScriptedRig& rig) {
        REQUIRE(rig.played(kFirst));
        rig.room.now += 3s;
        REQUIRE(rig.stage.heartbeat());
    };
    SUBCASE("phase beyond its budget") {
        ScriptedRig rig;
        show(rig);
        rig.room.phaseError = 230.0_us;
        CHECK(faultOf(rig) == "Slots and lens were 0.23 ms apart; check the trigger cable, then TAKE.");
        CHECK(safe(rig));
    }
    SUBCASE("lock lost") {
        ScriptedRig rig;
        show(rig);
        rig.room.locks = false;
        CHECK(faultOf(rig) ==
              "The lens's sweep has lost the projector's triggers; check the trigger cable, then TAKE.");
        CHECK(safe(rig));
    }
    SUBCASE("over-temperature") {
        ScriptedRig rig;
        show(rig);
        rig.room.temperature_C = 36.0;
        CHECK(faultOf(rig) == "The lens is at 36.0 C, too far from what its wave was planned for; let it come back, or "
                              "plan again at this temperature.");
        CHECK(safe(rig));
    }
    SUBCASE("the board flips to video, or swapped by force") {
        ScriptedRig rig;
        show(rig);
        rig.room.patterns = false;
        rig.room.troubles = {"It left pattern mode by itself."};
        CHECK(faultOf(rig) == "It left pattern mode by itself.");
        CHECK(safe(rig));
    }
    SUBCASE("the lens stopped by itself") {
        ScriptedRig rig;
        show(rig);
        rig.room.wave.reset();
        const auto beat = rig.stage.heartbeat();
        REQUIRE_FALSE(beat);
        CHECK(beat.error().what == "The lens does something else than it was told; was its driver restarted?");
        CHECK(safe(rig));
    }
    SUBCASE("the display is lost: the board makes its own white, until the next program") {
        ScriptedRig rig;
        show(rig);
        rig.orders();
        rig.video->lose();
        CHECK(faultOf(rig) == "The projector's display (HDMI-2) is gone. Check its cable and its power. The projector "
                              "shows its own white.");
        CHECK(rig.orders() == Calls{"video: white", "board: own white", "lens: safe"});
        CHECK(rig.room.ownWhite);
        CHECK_FALSE(rig.room.patterns);
        CHECK_FALSE(rig.room.wave);
        CHECK(rig.stage.report().projectorLine == "board: its display HDMI-2 is gone; steady white of its own");
        CHECK(rig.stage.report().light == LightMode::steady);
        CHECK_FALSE(rig.stage.report().well);
        CHECK_FALSE(rig.played(kFirst));  // there is nothing to play on
        CHECK(rig.room.ownWhite);

        rig.video->giveBack();
        rig.room.now += 1s;
        CHECK(rig.stage.heartbeat());
        CHECK(rig.room.ownWhite);  // going back is dark for a moment
        CHECK(safe(rig));
        CHECK(rig.stage.report().well);
        CHECK(rig.stage.report().projectorLine == "board: steady white of its own");
        rig.orders();
        REQUIRE(rig.played(kFirst));
        CHECK(rig.orders() == Calls{"video: white", "board: video", "lens: play", "board: start 16", "video: frame"});
        CHECK(rig.room.slotted());
        rig.stage.safeLight();
        CHECK_FALSE(rig.room.ownWhite);
        CHECK(rig.room.violations == Calls{});
    }
    SUBCASE("no video comes in although the display is there: as if it were lost") {
        const std::string noVideo = "The projector gets no video although its display is there; check the video cable "
                                    "at the projector's end, then TAKE. The projector shows its own white.";
        ScriptedRig rig;
        REQUIRE(rig.stage.heartbeat());
        rig.room.seesVideo = false;
        CHECK(faultOf(rig) == noVideo);
        CHECK(rig.room.ownWhite);
        CHECK(rig.stage.heartbeat());  // nothing is amiss in its own white
        const auto played = rig.played(kFirst);
        REQUIRE_FALSE(played);
        CHECK(played.error().what == noVideo);
        CHECK(rig.room.ownWhite);
        CHECK_FALSE(rig.room.wave);
        rig.room.seesVideo = true;
        CHECK(rig.played(kFirst));

        rig.room.now += 3s;
        rig.room.seesVideo = false;  // patterns stop with it
        rig.room.troubles = {"The sequencer gave up."};
        CHECK(faultOf(rig) == "The sequencer gave up. The projector shows its own white.");
        CHECK(rig.room.ownWhite);
    }
    SUBCASE("the board leaves its own white by itself: it is told again") {
        ScriptedRig rig;
        show(rig);
        rig.video->lose();
        faultOf(rig);
        rig.video->giveBack();
        rig.room.now += 1s;
        REQUIRE(rig.stage.heartbeat());
        rig.room.ownWhite = false;
        CHECK(faultOf(rig) == "The projector left its own white by itself, as it may when its video comes back; press "
                              "TAKE to start the slots again. The projector shows its own white.");
        CHECK(rig.room.ownWhite);
        CHECK(rig.stage.heartbeat());
    }
    SUBCASE("the board is unplugged: it is still sent white") {
        ScriptedRig rig;
        show(rig);
        rig.room.boardGone = true;
        CHECK(faultOf(rig) == "It failed (board: watch). The projector's light is not known.");
        CHECK(safe(rig));
        CHECK(rig.stage.report().projectorLine ==
              "LightCrafter 4500: no answer, it is sent white; its light is not known");
        rig.room.boardGone = false;
        rig.room.now += 1s;
        REQUIRE(rig.stage.heartbeat());
        CHECK(rig.stage.report().well);
        CHECK_FALSE(rig.room.patterns);
    }
    SUBCASE("the display is switched to another mode: it is white in that mode, at once") {
        ScriptedRig rig;
        show(rig);
        rig.video->change({{16, 8}, 60.0_Hz});
        CHECK(faultOf(rig) == "The projector's display was switched to another mode; set 912x1140, then TAKE.");
        CHECK(safe(rig));
        CHECK(rig.video->shown() == uniformFrame({16, 8}, 255));
        CHECK(rig.stage.report().projectorLine == "board: steady white");
        REQUIRE(rig.stage.heartbeat());
    }
    SUBCASE("the lenses are unplugged") {
        ScriptedRig rig;
        show(rig);
        rig.room.lensGone = true;
        CHECK(faultOf(rig) == "It failed (lens: heartbeat). Where the lens is, is not known.");
        CHECK(rig.room.whiteShown);
        CHECK(rig.stage.report().lensLine == "lenses: no answer; where they are is not known");
    }
}

TEST_CASE("lightcrafter stage: after a fault a bare swap lights nothing; a new load does") {
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    rig.room.now += 3s;
    rig.room.phaseError = 230.0_us;
    REQUIRE_FALSE(rig.stage.heartbeat());
    rig.room.phaseError = 0.0_us;
    const auto swapped = rig.stage.swap();
    REQUIRE_FALSE(swapped);
    CHECK(swapped.error().what == "Nothing is loaded that could be put on show.");
    CHECK_FALSE(rig.room.slotted());
    CHECK(rig.played(kFirst));

    // A swap that failed has used its program up, too.
    rig.room.failsAt = [](const std::string& call) { return call == "video: frame"; };
    REQUIRE_FALSE(rig.played(test::program(2)));
    rig.room.failsAt = {};
    CHECK_FALSE(rig.stage.swap());
    CHECK(safe(rig));
}

TEST_CASE("lightcrafter stage: light that came to be unknown is made white by the next heartbeat") {
    int left = 1;  // first: the stage makes safe light when it goes
    ScriptedRig rig;
    REQUIRE(rig.played(kFirst));
    rig.room.failsAt = [&](const std::string& call) {
        if (call == "video: white" && left-- > 0) throw std::bad_alloc();
        return false;
    };
    rig.stage.safeLight();
    CHECK(rig.stage.report().projectorLine == "board: its light is not known");
    REQUIRE(rig.stage.heartbeat());
    CHECK(safe(rig));
    CHECK(rig.stage.report().well);
}

TEST_CASE("lightcrafter stage: what cannot be locked or does not come at the sweep's rate never gets slots") {
    ScriptedRig rig;
    rig.room.locks = false;
    const auto shown = rig.played(kFirst);
    REQUIRE_FALSE(shown);
    CHECK(shown.error().what == "The lens's sweep does not lock to the projector's triggers; check the cable from "
                                "TRIG_OUT_2 to the DAC box, and the echo's wire.");
    CHECK(safe(rig));
    auto program = kFirst;
    program.waveform.rate = 59.94_Hz;
    program.slotRate = 16.0 * 59.94_Hz;
    rig.room.locks = true;
    rig.orders();
    const auto off = rig.played(program);
    REQUIRE_FALSE(off);
    CHECK(off.error().what.find("59.94 is not 60") != std::string::npos);
    const auto orders = rig.orders();
    CHECK(std::find(orders.begin(), orders.end(), "lens: play") == orders.end());
}

TEST_CASE("lightcrafter stage: refused programs leave the show as it is, and nothing to swap") {
    ScriptedRig rig;
    CHECK(rig.stage.swap().error().what == "Nothing is loaded that could be put on show.");
    REQUIRE(rig.played(kFirst));
    rig.orders();
    auto broken = kFirst;
    broken.imageOfSlot.front() = 99;
    CHECK_FALSE(rig.stage.load(broken));
    CHECK_FALSE(rig.stage.swap().has_value());
}

}  // namespace ilf::devices
