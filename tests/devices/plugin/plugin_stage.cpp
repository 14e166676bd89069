#include "devices/plugin/plugin_stage.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "devices/plugin/slot_pictures.h"
#include "devices/simulated/simulated_stage.h"
#include "tests/devices/plugin/loopback_rig.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::kSmall;
using test::LoopbackRig;
using Calls = std::vector<std::string>;

Program program(std::uint32_t seed, Dioptre high = 2.27_D) { return test::program(seed, high, kSmall); }

Program slower() {
    auto slow = program(3);
    slow.slotRate = 480.0_Hz;
    slow.imageOfSlot.resize(8);
    return slow;
}

/// What a show's heartbeat says at the fault, which must have ended in safe light.
std::string faultOf(LoopbackRig& rig) {
    const auto beat = rig.stage.heartbeat();
    CHECK(rig.violations == Calls{});
    CHECK(rig.safe());
    CHECK_FALSE(rig.stage.swap());  // slots need a new load
    CHECK_FALSE(rig.slotted());
    return beat ? "nothing" : beat.error().what;
}

bool shows(const LoopbackRig& rig, const Program& program) {
    const auto pictures = slotPictures(program, 8);
    if (rig.loopback.slots() != pictures.size()) return false;
    for (std::uint32_t slot = 0; slot < pictures.size(); ++slot)
        if (!(rig.loopback.lightOf(slot, kSmall) == pictures[slot])) return false;
    return true;
}

}  // namespace

TEST_CASE("plugin stage: a start is steady white, the sweep, white slots, then the program's pictures") {
    LoopbackRig rig;
    REQUIRE(rig.played(program(1)));
    CHECK(rig.orders() == Calls{"projector: open", "projector: describe", "lens: opened at 0.0",
                                "projector: steady_white", "lens: safe", "lens: play", "projector: configure",
                                "projector: upload", "projector: swap", "projector: start", "projector: upload",
                                "projector: swap"});
    CHECK(rig.slotted());
    CHECK(shows(rig, program(1)));
    const auto report = rig.stage.report();
    CHECK(report.light == LightMode::slotted);
    CHECK(report.well);
    CHECK(report.projectorLine ==
          "Loopback projector (makes no light) at loopback: 16 slots a sweep at 960.00 slots a second");
    REQUIRE(report.devices.size() == 2);
    CHECK(report.devices[0].health == DeviceHealth::well);
    CHECK(rig.violations == Calls{});

    rig.stage.safeLight();
    CHECK(rig.orders() == Calls{"projector: steady_white", "lens: safe"});
    CHECK(rig.safe());
    CHECK(rig.stage.report().projectorLine == "Loopback projector (makes no light) at loopback: steady white");
    CHECK(rig.stage.report().lens == LensMode::rest);
    REQUIRE(rig.stage.heartbeat());
}

TEST_CASE("plugin stage: the same wave is sent beside what plays, and changed in one call at a sweep's start") {
    LoopbackRig rig;
    REQUIRE(rig.played(program(1)));
    rig.orders();
    REQUIRE(rig.stage.load(program(2)));
    CHECK(rig.orders() == Calls{"projector: upload"});
    CHECK(shows(rig, program(1)));
    const auto loaded = rig.loopback.clock().now();
    REQUIRE(rig.stage.swap());
    CHECK(rig.orders() == Calls{"projector: swap"});
    CHECK(shows(rig, program(2)));
    CHECK(rig.stage.lightBegan() - loaded <= 16'666'669ns);  // one sweep
    REQUIRE(rig.stage.swap());                               // again: its back buffer is empty by now
    CHECK(rig.orders() == Calls{"projector: upload", "projector: swap"});
    CHECK(shows(rig, program(2)));
}

TEST_CASE("plugin stage: another wave goes through white slots, another rate through steady white") {
    LoopbackRig rig;
    REQUIRE(rig.played(program(1)));
    rig.orders();
    const Calls whiteThenWave{"projector: upload", "projector: swap", "lens: play", "projector: upload",
                              "projector: swap"};
    REQUIRE(rig.played(program(2, 5.0_D)));
    CHECK(rig.orders() == whiteThenWave);
    auto later = program(2, 5.0_D);
    later.projectorDelay = 0.6_ms;
    REQUIRE(rig.played(later));
    CHECK(rig.orders() == whiteThenWave);
    REQUIRE(rig.played(slower()));
    CHECK(rig.orders() == Calls{"projector: upload", "projector: swap", "lens: play", "projector: stop",
                                "projector: configure", "projector: upload", "projector: swap", "projector: start",
                                "projector: upload", "projector: swap"});
    CHECK(shows(rig, slower()));
    CHECK(rig.violations == Calls{});
}

TEST_CASE("plugin stage: slots wait until the lens is predicted to be settled") {
    LoopbackRig rig;
    std::chrono::nanoseconds told{0}, lit{0};
    rig.failsAt = [&](const std::string& call) {
        if (call == "lens: play") told = rig.loopback.clock().now();
        if (call == "projector: swap") lit = rig.loopback.clock().now();
        return false;
    };
    REQUIRE(rig.played(program(1)));
    const double settling = kLensTimeConstant.si() * std::log(2.27 / kSettledLens.si());
    CHECK(std::chrono::duration<double>(lit - told).count() >= 0.06 + settling);
    rig.failsAt = nullptr;
}

TEST_CASE("plugin stage: a wearer who rests elsewhere gets lenses that rest there") {
    LoopbackRig rig;
    REQUIRE(rig.played(program(1)));
    rig.orders();
    auto other = program(1);
    other.waveform = idealSine(1.5_D, 1.5_D, 3.0_D, 60.0_Hz, 0.0_s);
    REQUIRE(rig.played(other));
    const auto orders = rig.orders();
    CHECK(std::find(orders.begin(), orders.end(), "lens: opened at 1.5") != orders.end());
    rig.stage.safeLight();
    CHECK(rig.stage.report().lensPower == 1.5_D);
    CHECK(rig.violations == Calls{});
}

TEST_CASE("plugin stage: every fault of a show ends in safe light, with one sentence") {
    LoopbackRig rig;
    REQUIRE(rig.played(program(1)));
    rig.loopback.pass(3s);
    REQUIRE(rig.stage.heartbeat());
    CHECK(rig.stage.report().devices[0].line == "It shows 16 slots a sweep at 960.00 slots a second. Of 2880 frames 0 "
                                                "were dropped.");
    const auto tell = [&](const char* faults) {
        rig.loopback.faults(faults);
        rig.loopback.pass(1s);
        return faultOf(rig);
    };
    SUBCASE("a dropped frame") {
        CHECK(tell("drop=900") ==
              "The projector dropped 1 of 3840 frames; lower the rig's slot rate, or close what else "
              "keeps this machine busy, then TAKE.");
        CHECK(rig.stage.report().devices[0].health == DeviceHealth::wrongMode);
        rig.loopback.faults("");
        CHECK(rig.stage.heartbeat());
        CHECK(rig.played(program(2)));  // what was dropped before is not held against it
        CHECK(rig.stage.heartbeat());
        CHECK(rig.stage.report().devices[0].health == DeviceHealth::well);
    }
    SUBCASE("an underrun") {
        CHECK(tell("underrun=30") ==
              "The projector had no picture for a slot (2 underruns); close what else keeps this "
              "machine busy, then TAKE.");
    }
    SUBCASE("a lost trigger") {
        CHECK(tell("lose_trigger=50") == "The projector lost 1 trigger; check the trigger cable, then TAKE.");
    }
    SUBCASE("too hot") {
        CHECK(tell("hot=1") == "The projector is too hot; check its fans and what stands in their way.");
    }
    SUBCASE("no light") {
        CHECK(tell("dark=1") == "The projector's light source has failed; switch it off and on, or have it serviced.");
    }
    SUBCASE("another clock") {
        CHECK(tell("ppm=-1000") == "The projector's slots come at 959.04 Hz, not at the program's 960.00 Hz; set the "
                                   "rig's slot rate to what it can keep.");
    }
    SUBCASE("a picture that is stuck") {
        rig.loopback.faults("stuck=1");
        const auto shown = rig.played(program(2));
        REQUIRE_FALSE(shown);
        CHECK(shown.error().what == "The projector shows another program than it was told.");
        CHECK(rig.safe());
    }
    SUBCASE("an answer that takes too long") {
        rig.loopback.faults("slow=status:400");
        CHECK(faultOf(rig) ==
              "loopback 1 (loopback_projector.so) took 0.40 s to say how the projector is, where 0.25 s "
              "are allowed.");
    }
    SUBCASE("white that takes too long is still white, and told") {
        rig.loopback.faults("slow=steady_white:700");
        rig.stage.safeLight();
        CHECK(rig.safe());
        CHECK(rig.stage.report().well);
        CHECK(rig.stage.report().projectorLine == "Loopback projector (makes no light) at loopback: steady white; "
                                                  "loopback 1 (loopback_projector.so) took 0.70 s to show "
                                                  "steady white, where 0.50 s are allowed.");
    }
    SUBCASE("phase, lock, temperature, a lens that stopped") {
        SUBCASE("phase") { rig.phaseError = 230.0_us; }
        SUBCASE("lock") { rig.locks = false; }
        SUBCASE("temperature") { rig.temperature_C = 36.0; }
        SUBCASE("stopped") { rig.wave.reset(), rig.violations.clear(); }
        CHECK_FALSE(rig.stage.heartbeat());
        CHECK(rig.safe());
    }
    SUBCASE("the projector is unplugged, and comes back") {
        rig.projectorGone = true;
        const auto beat = rig.stage.heartbeat();
        REQUIRE_FALSE(beat);
        CHECK(beat.error().what.find(" The projector's light is not known.") != std::string::npos);
        CHECK_FALSE(rig.wave);
        CHECK_FALSE(rig.stage.report().well);
        rig.loopback.pass(1s);
        CHECK_FALSE(rig.stage.heartbeat());
        CHECK(rig.stage.report().devices[0].health == DeviceHealth::unplugged);
        CHECK(rig.stage.report().devices[0].line == "There is no projector.");
        rig.projectorGone = false;
        rig.loopback.pass(1s);
        CHECK(rig.stage.heartbeat());
        CHECK(rig.safe());
        CHECK(rig.stage.report().well);
    }
}

TEST_CASE("plugin stage: what does not fit the projector is refused before the lens moves") {
    LoopbackRig rig;
    rig.stage.safeLight();
    const auto refused = [&](const Program& wrong) {
        rig.orders();
        const auto shown = rig.played(wrong);
        const auto orders = rig.orders();
        CHECK(std::find(orders.begin(), orders.end(), "lens: play") == orders.end());
        CHECK(rig.safe());
        return shown ? "nothing" : shown.error().what;
    };
    CHECK(refused(test::program(1, 2.27_D, {16, 4})) == "The program is for 16x4 pixels, Loopback projector (makes no "
                                                        "light) at loopback has 8x4; set the rig's projector to "
                                                        "that.");
    auto fast = program(1);
    fast.slotRate = 1020.0_Hz;
    fast.imageOfSlot.push_back(0);
    CHECK(refused(fast) ==
          "Loopback projector (makes no light) at loopback shows pictures of 8 bits at 1 to 1000 Hz, not at 1020 "
          "Hz; change the rig to what it can do.");
    CHECK(rig.stage.swap().error().what == "Nothing is loaded that could be put on show.");
    rig.locks = false;
    const auto unlocked = rig.played(program(1));
    REQUIRE_FALSE(unlocked);
    CHECK(unlocked.error().what.find("does not lock to the projector's triggers") != std::string::npos);
    CHECK(rig.safe());
}

}  // namespace ilf::devices
