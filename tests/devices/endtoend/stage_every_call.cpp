// An evening with the real drivers over emulated cables, in which each call of a cable or of the display fails once.
#include <doctest/doctest.h>

#include <utility>

#include "devices/simulated/simulated_stage.h"
#include "tests/devices/endtoend/stage_bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using namespace std::chrono_literals;

namespace {

/// Sanitizers take ten times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kStep = 7;
#else
constexpr int kStep = 1;
#endif

/// Made once: a program's pictures take longer than playing them.
const Program& first() {
    static const Program program = evening(70);
    return program;
}
const Program& second() {
    static const Program program = evening(71);
    return program;
}

/// Stops at the first failure, as a player does.
Result<void> played(StageBench& room) {
    if (auto shown = room.played(first()); !shown) return shown;
    // The box is asked at each beat, the board each second; between these beats differ in nothing.
    room.bench.advance(std::chrono::nanoseconds(900ms).count());
    if (const auto fault = room.beats(2)) return fail(Fault::device, *fault);
    if (auto shown = room.played(second()); !shown) return shown;
    if (const auto fault = room.beats(1)) return fail(Fault::device, *fault);
    room.stage->safeLight();
    return room.stage->heartbeat();
}

/// A display that is pulled for two seconds, and a program after it.
Result<void> lostAndBack(StageBench& room) {
    if (auto shown = room.played(first()); !shown) return shown;
    (void)room.beats(1);
    room.unplugDisplay();
    (void)room.beats(12);
    const bool lit = room.white();
    room.plugDisplay();
    (void)room.beats(12);
    if (const auto fault = room.beats(2)) return fail(Fault::device, *fault);
    if (!lit) return fail(Fault::device, "It was dark.");
    if (auto shown = room.played(second()); !shown) return shown;
    room.stage->safeLight();
    return room.stage->heartbeat();
}

}  // namespace

TEST_CASE("stage over USB: an evening without faults plays in step and ends lit and at rest") {
    StageBench room;
    REQUIRE(room.played(first()));
    CHECK(room.bench.board.running());
    CHECK_FALSE(room.lensesRest());
    CHECK_FALSE(room.beats(30));
    const auto report = room.stage->report();
    CHECK(report.light == LightMode::slotted);
    REQUIRE(report.timing);
    CHECK(report.timing->locked);
    CHECK(report.timing->phase <= kPhaseBudget);
    CHECK(report.timing->jitter <= report.timing->phase);
    CHECK(report.timing->missedTriggers == 0);
    CHECK(room.line("projector").name == "LightCrafter 4500 at USB 1-2");
    CHECK(room.line("lenses").name == "lenses on the USB-1208FS-Plus at USB 1-3");
    for (const auto& line : report.devices)
        CHECK(line.health == DeviceHealth::well);
    room.stage->safeLight();
    room.bench.frames(3);
    CHECK(room.white());
    CHECK(room.lensesRest());
    CHECK(room.bench.board.ledCurrentWrites() == 0);
    CHECK_FALSE(room.bench.board.harmed());
}

TEST_CASE("stage over USB: the first light of a new program comes within one sweep and one frame of its last byte") {
    StageBench room;
    REQUIRE(room.played(first()));
    for (const std::int64_t within_ns : {0, 5'000'000, 16'000'000}) {
        REQUIRE_FALSE(room.beats(2));
        room.bench.advance(within_ns);
        const Program& next = within_ns == 5'000'000 ? first() : second();
        REQUIRE(room.stage->load(next));
        const std::int64_t loaded_ns = room.bench.now_ns();
        REQUIRE(room.stage->swap());
        // A sweep is as long as a frame.
        CHECK(room.stage->lightBegan().count() - loaded_ns <= 2 * Bench::kFrame_ns + 2);
        (void)room.bench.takeLight();
        const auto wanted = intendedSweep(next, 1);
        bool seen = false;
        room.bench.frames(2);
        for (const auto& slot : room.bench.takeLight()) {
            if (slot.start_ns < room.stage->lightBegan().count()) continue;
            seen = true;
            CHECK(taken(slot, 0).light == wanted[static_cast<std::size_t>(slot.pattern)].light);
        }
        CHECK(seen);
    }
}

TEST_CASE("stage over USB: whichever call of a cable or the display fails, the scene ends lit and the lenses at rest") {
    struct Case {
        Result<void> (*evening)(StageBench& room);
        bool afterEffect;
        int step;
    };
    // What comes before the display is pulled is the evening that went before: some of its calls will do.
    for (const auto& [evening, afterEffect, step] :
         {Case{played, false, kStep}, Case{played, true, kStep}, Case{lostAndBack, false, 5 * kStep},
          Case{lostAndBack, true, 5 * kStep}}) {
        bool untouched = false;
        int failing = 1, faults = 0;
        for (; !untouched; failing += step) {
            REQUIRE(failing < 2000);
            CAPTURE(failing);
            CAPTURE(afterEffect);
            int calls = 0;
            StageBench room;
            room.afterEffect = afterEffect;
            room.spoils = [&] { return ++calls == failing; };
            const auto done = evening(room);
            untouched = calls < failing;
            if (untouched) {
                CHECK(done);
                break;
            }
            if (!done) ++faults;
            // Whatever was lost meanwhile is told again within seconds, and slots are not lit by it.
            const auto well = [&] {
                return !room.bench.board.running() && room.lensesRest() && room.stage->report().well && room.white();
            };
            for (int beat = 0; beat < 13 && (room.beats(1) || !well()); ++beat) {
            }
            CHECK_FALSE(room.beats(2));
            CHECK_FALSE(room.bench.board.running());
            CHECK(room.white());
            CHECK(room.lensesRest());
            CHECK(room.stage->report().well);
        }
        CHECK(failing > 150);
        CHECK(faults * step > 100);
    }
}
