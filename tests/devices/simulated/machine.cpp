#include "devices/simulated/machine.h"

#include <doctest/doctest.h>

#include "devices/link/program_update.h"
#include "tests/devices/programs.h"

namespace ilf::devices {
namespace {

constexpr std::int64_t kMs = 1'000'000;

bool done(const Body& answer) { return std::holds_alternative<Done>(answer); }

/// A machine that shows `program` from `now` on.
Machine showing(const Program& program, std::int64_t now) {
    Machine machine(0);
    REQUIRE(done(machine.answered(difference(program, contentHash(program)), 0)));
    REQUIRE(done(machine.answered(SetWaveform{program.waveform}, 0)));
    const Body swapped = machine.answered(Swap{}, 1);
    REQUIRE(done(swapped));
    REQUIRE(std::get<Done>(swapped).at_ns <= now);
    machine.advance(now);
    return machine;
}

}  // namespace

TEST_CASE("machine: switched on, it shows steady light with the lens at rest") {
    const auto state = Machine().state(0);
    CHECK(state.light == LightMode::steady);
    CHECK(state.lens == LensMode::rest);
    CHECK(state.powerNow == 0.0_D);
    CHECK(state.hashShown == 0);
}

TEST_CASE("machine: a swap happens at the start of a sweep and not before") {
    const auto program = test::program(1);
    Machine machine(0);
    machine.answered(difference(program, contentHash(program)), 0);
    machine.answered(SetWaveform{program.waveform}, 0);
    const auto at = std::get<Done>(machine.answered(Swap{}, 5 * kMs)).at_ns;
    CHECK(at == 16'666'667);
    machine.advance(at - 1);
    CHECK(machine.light() == LightMode::steady);
    machine.advance(at);
    CHECK(machine.light() == LightMode::slotted);
    const auto state = machine.state(at);
    CHECK(state.hashShown == contentHash(program));
    CHECK(state.slotHashes.size() == 16);
    CHECK(state.slotHashes[2] == 0);
    CHECK(std::get<SlotImage>(machine.answered(ReadSlot{7}, at)).image == program.images[1]);
    CHECK(std::holds_alternative<Refused>(machine.answered(ReadSlot{16}, at)));
}

TEST_CASE("machine: steady light takes back a swap that waits") {
    const auto program = test::program(1);
    Machine machine(0);
    machine.answered(difference(program, contentHash(program)), 0);
    machine.answered(SetWaveform{program.waveform}, 0);
    machine.answered(Swap{}, 5 * kMs);
    machine.answered(SteadyLight{}, 6 * kMs);
    machine.advance(100 * kMs);
    CHECK(machine.light() == LightMode::steady);
}

TEST_CASE("machine: it refuses another slot rate under slotted light, and counts it") {
    auto machine = showing(test::program(1), 20 * kMs);
    CHECK(std::holds_alternative<Refused>(machine.answered(SetSlotRate{480.0_Hz}, 21 * kMs)));
    CHECK(machine.state(21 * kMs).rateChangesUnderSlottedLight == 1);
    CHECK(machine.state(21 * kMs).slotRate == 960.0_Hz);
    machine.answered(SetWaveform{test::program(1, 1.0_D).waveform}, 22 * kMs);
    CHECK(machine.state(22 * kMs).waveformChangesUnderSlottedLight == 1);
}

TEST_CASE("machine: it refuses what it cannot show") {
    Machine machine(0);
    CHECK(std::holds_alternative<Refused>(machine.answered(Swap{}, 0)));
    Waveform endless = test::program(1).waveform;
    endless.high = 1.0 / 0.0_m;
    CHECK(std::holds_alternative<Refused>(machine.answered(SetWaveform{endless}, 0)));
    CHECK(std::holds_alternative<Refused>(machine.answered(SetSlotRate{0.0_Hz}, 0)));
    const auto program = test::program(1);
    const auto next = test::dabbed(program, 5);
    const auto answer = machine.answered(difference(next, contentHash(next), &program, contentHash(program)), 0);
    REQUIRE(std::holds_alternative<Refused>(answer));
    CHECK(std::get<Refused>(answer).sendWhole);
    CHECK(std::holds_alternative<Refused>(machine.answered(Hello{}, 0)));
    CHECK(machine.state(0).refusals == 5);
}

TEST_CASE("machine: the watchdog makes the light safe when the player is silent, and not while it is heard") {
    auto machine = showing(test::program(1), 20 * kMs);
    machine.setWatchdog(800 * kMs);
    machine.playerHeard(1000 * kMs);
    machine.advance(1700 * kMs);
    CHECK(machine.light() == LightMode::slotted);
    machine.advance(1801 * kMs);
    CHECK(machine.light() == LightMode::steady);
    CHECK(machine.lens() == LensMode::rest);
    CHECK(machine.state(1801 * kMs).watchdogTrips == 1);
    CHECK(machine.state(1801 * kMs).waveformChangesUnderSlottedLight == 0);
}

}  // namespace ilf::devices
