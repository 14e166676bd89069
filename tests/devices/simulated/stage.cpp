#include <doctest/doctest.h>

#include <algorithm>

#include "devices/simulated/virtual_stage.h"
#include "tests/devices/programs.h"

namespace ilf::devices {
namespace {

Result<void> played(Stage& stage, const Program& program) {
    return stage.load(program).and_then([&] { return stage.swap(); });
}

/// What a player does in an evening; stops at the first failure, as a player does.
Result<void> evening(Stage& stage) {
    auto slower = test::program(3);
    slower.slotRate = 480.0_Hz;
    slower.imageOfSlot.resize(8);
    for (const auto& program : {test::program(1), test::dabbed(test::program(1), 9), test::program(2, 4.27_D), slower})
        if (const auto shown = played(stage, program); !shown) return shown;
    return stage.heartbeat();
}

}  // namespace

TEST_CASE("stage: whichever call fails, and however often, the scene is lit and the lens rests") {
    for (int lost = 1; lost <= 2; ++lost) {
        bool untouched = false;
        for (int failing = 1; !untouched; ++failing) {
            REQUIRE(failing < 200);
            CAPTURE(failing);
            CAPTURE(lost);
            VirtualStage stage;
            int calls = 0;
            stage.port.failsAt = [&](const Body&) {
                ++calls;
                return calls >= failing && calls < failing + lost;
            };
            // A single lost question is asked again and disturbs nothing; what is lost for good ends in safe light.
            untouched = evening(stage).has_value() && calls < failing;
            if (calls >= failing) stage.safeLight();
            if (untouched) break;
            CHECK(stage.state().light == LightMode::steady);
            CHECK(stage.state().lens == LensMode::rest);
            CHECK(stage.state().rateChangesUnderSlottedLight == 0);
            CHECK(stage.state().waveformChangesUnderSlottedLight == 0);
            // And it can play again.
            CHECK(played(stage, test::program(5)).has_value());
        }
    }
}

TEST_CASE("stage: an evening without faults never touches wave or slot rate under slotted light") {
    VirtualStage stage;
    REQUIRE(evening(stage));
    const auto state = stage.state();
    CHECK(state.light == LightMode::slotted);
    CHECK(state.swaps == 4);
    CHECK(state.slotRate == 480.0_Hz);
    CHECK(state.rateChangesUnderSlottedLight == 0);
    CHECK(state.waveformChangesUnderSlottedLight == 0);
    CHECK(state.refusals == 0);
}

TEST_CASE("stage: the same wave is swapped within a sweep, without steady light between") {
    VirtualStage stage;
    REQUIRE(played(stage, test::program(1)));
    const auto before = stage.port.nowNs();
    const auto orders = stage.port.log.size();
    REQUIRE(played(stage, test::program(2)));
    CHECK(stage.port.nowNs() - before <= 16'666'667);
    CHECK(std::find(stage.port.log.begin() + static_cast<std::ptrdiff_t>(orders), stage.port.log.end(),
                    "steady light") == stage.port.log.end());
    CHECK(stage.state().hashShown == contentHash(test::program(2)));
}

TEST_CASE("stage: another wave keeps steady light until the lens is within its budget") {
    VirtualStage stage;
    REQUIRE(played(stage, test::program(1)));
    bool tooEarly = false;
    stage.port.failsAt = [&](const Body& order) {
        const auto now = stage.state();
        if (std::holds_alternative<Swap>(order)) tooEarly = now.lensError > kSettledLens;
        return false;
    };
    REQUIRE(played(stage, test::program(2, 5.0_D)));
    CHECK_FALSE(tooEarly);
    CHECK(stage.state().waveform.high == 5.0_D);
}

TEST_CASE("stage: a dab uploads one tile; a projector that forgot gets the whole program") {
    VirtualStage stage;
    REQUIRE(played(stage, test::program(1)));
    const auto before = stage.state().tilesReceived;
    REQUIRE(stage.load(test::dabbed(test::program(1), 8)));
    CHECK(stage.state().tilesReceived == before + 1);
    stage.port.machine = Machine(stage.port.nowNs());
    REQUIRE(stage.load(test::dabbed(test::program(1), 9)));
    CHECK(stage.state().hashLoaded == contentHash(test::dabbed(test::program(1), 9)));
}

TEST_CASE("stage: a heartbeat notices devices that do something else than they were told") {
    VirtualStage stage;
    REQUIRE(played(stage, test::program(1)));
    REQUIRE(stage.heartbeat());
    stage.port.machine.answered(SteadyLight{}, stage.port.nowNs());
    CHECK(stage.heartbeat().error().what ==
          "The projector went to steady light by itself; was it switched off and on?");
    VirtualStage other;
    REQUIRE(played(other, test::program(1)));
    other.port.machine.answered(SetWaveform{test::program(1, 7.0_D).waveform}, other.port.nowNs());
    CHECK(other.heartbeat().error().what == "The lens does something else than it was told; was its driver restarted?");
}

TEST_CASE("stage: safe light rests the lens at the wearer's resting power") {
    auto program = test::program(1);
    program.waveform = idealSine(1.5_D, 1.5_D, 3.0_D, 60.0_Hz, 0.0_s);
    VirtualStage stage;
    REQUIRE(played(stage, program));
    stage.safeLight();
    stage.port.waitUntil(stage.port.nowNs() + 200'000'000);
    CHECK(stage.state().powerNow.si() == doctest::Approx(1.5).epsilon(1e-6));
    CHECK(stage.report().lens == LensMode::rest);
    REQUIRE(stage.heartbeat());
}

}  // namespace ilf::devices
