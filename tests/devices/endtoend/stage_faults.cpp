// Every fault an evening can have: what the operator reads, where the light ends, and how the device's line tells it.
// The README's table of faults is this file in words.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/devices/endtoend/stage_bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::test;
using emulators::DeviceFault;
using emulators::Mishap;

namespace {

const Program& show() {
    static const Program program = evening(80);
    return program;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A show that was well for a third of a second.
struct Playing {
    StageBench room;
    Playing() {
        REQUIRE(room.played(show()));
        REQUIRE_FALSE(room.beats(4));
        REQUIRE(room.stage->report().light == LightMode::slotted);
    }
    /// What is read at the fault, within three seconds.
    std::string reads() {
        const auto read = room.beats(30);
        return read ? *read : "nothing";
    }
    void endsLitAndAtRest() {
        room.bench.frames(3);
        CHECK_FALSE(room.bench.board.running());
        CHECK(room.white());
        CHECK(room.lensesRest());
        CHECK(room.stage->report().light == LightMode::steady);
    }
    /// With the cause gone: all is well, in white, and nothing lights slots but a new program.
    void recovers() {
        room.bench.board.setFaults({});
        room.daq.setFaults({});
        room.beats(12);
        CHECK_FALSE(room.beats(3));
        CHECK(room.stage->report().well);
        CHECK_FALSE(room.stage->swap());
        endsLitAndAtRest();
        CHECK(room.played(show()));
    }
};

}  // namespace

TEST_CASE("faults of a show: the projector refuses, is silent or stalls for good") {
    for (const auto& [kind, words] :
         {std::pair(Mishap::nack, "refused to tell its"), std::pair(Mishap::silence, "did not answer"),
          std::pair(Mishap::stall, "did not answer")}) {
        CAPTURE(words);
        Playing evening;
        evening.room.bench.board.setFaults({{kind}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, words), read);
        CHECK(contains(read, "The LightCrafter 4500 at 1-2"));
        CHECK(contains(read, "The projector's light is not known."));
        // It cannot be told, but every one of its slots is white.
        CHECK(evening.room.white());
        CHECK(evening.room.lensesRest());
        CHECK(evening.room.line("projector").health == DeviceHealth::silent);
        evening.recovers();
    }
}

TEST_CASE("faults of a show: a message to the projector that is lost once") {
    for (const Mishap kind : {Mishap::nack, Mishap::silence, Mishap::stall}) {
        CAPTURE(static_cast<int>(kind));
        Playing evening;
        evening.room.bench.board.setFaults({{kind, 0, 1}});
        CHECK(evening.reads() != "nothing");
        evening.endsLitAndAtRest();
        evening.recovers();
    }
}

TEST_CASE("faults of a show: the projector's cable is pulled, at any byte") {
    for (const std::uint64_t bytes : {0U, 1U, 40U, 64U, 100U, 200U}) {
        CAPTURE(bytes);
        Playing evening;
        evening.room.bench.board.setFaults({{Mishap::unplug, bytes, 1}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, "Plug it in again."), read);
        CHECK(evening.room.white());  // in every slot it still shows
        CHECK(evening.room.lensesRest());
        evening.recovers();
    }
    Playing evening;
    evening.room.boardUnplugged = true;
    CHECK(contains(evening.reads(), "Plug it in again."));
    CHECK(evening.room.white());  // in every slot it still shows
    CHECK(evening.room.lensesRest());
    CHECK(evening.room.line("projector").health == DeviceHealth::unplugged);
    CHECK(evening.room.line("projector").line == "No USB device is plugged in at 1-2. Plug it in at that port.");
    evening.room.boardUnplugged = false;
    evening.recovers();
}

TEST_CASE("faults of a show: the projector leaves its patterns by itself") {
    Playing evening;
    evening.room.bench.board.setFaults({{Mishap::wrongMode, 0, 1}});
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "left pattern mode by itself"), read);
    CHECK(contains(read, "Press TAKE"));
    CHECK(evening.room.line("projector").health == DeviceHealth::wrongMode);
    evening.endsLitAndAtRest();
    evening.recovers();
}

TEST_CASE("faults of a show: triggers that do not come") {
    {
        Playing evening;
        evening.room.bench.board.setFaults({{Mishap::droppedTrigger, 10, 1}});
        CHECK(evening.reads() == "nothing");  // one is bridged, and counted
        REQUIRE(evening.room.stage->report().timing);
        CHECK(evening.room.stage->report().timing->missedTriggers == 1);
        CHECK(evening.room.bench.board.running());
    }
    Playing evening;
    evening.room.bench.board.setFaults({{Mishap::droppedTrigger, 10}});
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "The projector's trigger is lost"), read);
    evening.endsLitAndAtRest();
    evening.recovers();
}

TEST_CASE("faults of a show: clocks that drift are followed, and too far apart are refused") {
    // A converter's clock counts from the start of its scan.
    {
        StageBench room;
        room.daq.setFaults({{Mishap::clockDrift, 0, 1, 60.0}});
        REQUIRE(room.played(show()));
        CHECK_FALSE(room.beats(30));
        REQUIRE(room.stage->report().timing);
        CHECK(std::abs(std::abs(room.stage->report().timing->driftPpm) - 60.0) < 30.0);
    }
    StageBench room;
    room.daq.setFaults({{Mishap::clockDrift, 0, 1, 2000.0}});
    const auto started = room.played(show());
    REQUIRE_FALSE(started);
    CHECK_MESSAGE(contains(started.error().what, "too far apart to be kept in step"), started.error().what);
    room.bench.frames(3);
    CHECK(room.white());
    CHECK(room.lensesRest());
    room.daq.setFaults({});
    room.beats(12);
    CHECK(room.played(show()));
}

TEST_CASE("faults of a show: a picture that stays is not told by the board, and ends in white when it is let go") {
    Playing evening;
    evening.room.bench.board.setFaults({{Mishap::stuckFrame}});
    CHECK(evening.reads() == "nothing");  // nothing on the cables tells; comparing light received with intended does
    evening.room.stage->safeLight();
    evening.endsLitAndAtRest();  // by what the display is told
    const auto lit = [&] {
        (void)evening.room.bench.takeLight();
        evening.room.bench.frames(60);
        const auto light = evening.room.bench.takeLight();
        REQUIRE_FALSE(light.empty());
        CHECK(light.back().video);
        return std::ranges::all_of(taken(light.back(), 0).light.pixels(), [](std::uint8_t v) { return v == 255; });
    };
    CHECK_FALSE(lit());
    evening.room.bench.board.setFaults({});
    CHECK(lit());
    CHECK(evening.room.played(show()));
}

TEST_CASE("faults of a show: the lenses' box refuses or is silent for a moment") {
    for (const auto& [kind, words] :
         {std::pair(Mishap::nack, "refused (stalled)"), std::pair(Mishap::silence, "ran out of samples")}) {
        CAPTURE(words);
        Playing evening;
        evening.room.daq.setFaults({{kind, 0, 40}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, words), read);
        evening.endsLitAndAtRest();
        evening.recovers();
    }
}

TEST_CASE("faults of a show: the lenses' box refuses for good, and is brought to rest by its samples") {
    Playing evening;
    evening.room.daq.setFaults({{Mishap::nack}});
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "refused (stalled)"), read);
    CHECK_FALSE(contains(read, "Where the lens is"));
    CHECK(evening.room.white());
    CHECK(evening.room.line("lenses").health == DeviceHealth::silent);
    for (int i = 0; i < 20; ++i) {
        const auto codes = evening.room.daq.outputs(evening.room.bench.now_ns()).codes;
        CHECK(std::abs(int(codes[0]) - 2048) <= 1);
        CHECK(std::abs(int(codes[1]) - 2048) <= 1);
        evening.room.beats(1);
    }
    evening.recovers();
}

TEST_CASE("faults of a show: the lenses' box is silent for good, and holds them until it answers or has no power") {
    for (const bool unplugged : {false, true}) {
        CAPTURE(unplugged);
        Playing evening;
        auto& room = evening.room;
        room.daq.setFaults({{Mishap::silence}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, "did not answer in time"), read);
        CHECK(contains(read, "Where the lens is, is not known."));
        CHECK(room.white());
        const auto held = room.daq.outputs(room.bench.now_ns());
        room.beats(10);
        CHECK(room.daq.outputs(room.bench.now_ns()).codes == held.codes);
        if (unplugged) {
            room.unplugLenses();
            const auto cut = room.daq.outputs(room.bench.now_ns());
            CHECK(room.daq.current_mA(cut, 0) == 0.0);
            CHECK(room.daq.current_mA(cut, 1) == 0.0);
            CHECK(room.white());
            room.lensesUnplugged = false;
        }
        evening.recovers();
    }
}

TEST_CASE("faults of a show: the lenses' box stalls or runs out of samples") {
    const std::string words = "ran out of samples";  // which is how the box says both
    for (const Mishap kind : {Mishap::stall, Mishap::underrun}) {
        CAPTURE(static_cast<int>(kind));
        Playing evening;
        evening.room.daq.setFaults({{kind, 3, 1}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, words), read);
        evening.endsLitAndAtRest();
        evening.recovers();
    }
}

TEST_CASE("faults of a show: the lenses' cable is pulled, at any byte") {
    for (const std::uint64_t bytes : {0U, 1U, 63U, 64U, 1000U, 5000U}) {
        CAPTURE(bytes);
        Playing evening;
        evening.room.daq.setFaults({{Mishap::unplug, bytes, 1}});
        const std::string read = evening.reads();
        CHECK_MESSAGE(contains(read, "Plug it in again."), read);
        CHECK(contains(read, "Where the lens is, is not known."));
        CHECK(evening.room.white());
        evening.recovers();
    }
    Playing evening;
    evening.room.unplugLenses();
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "is gone. Plug it in again."), read);
    CHECK(contains(read, "Where the lens is, is not known."));
    CHECK(evening.room.white());
    CHECK(evening.room.line("lenses").health == DeviceHealth::unplugged);
    CHECK(evening.room.line("lenses").line == "No USB device is plugged in at 1-3. Plug it in at that port.");
    evening.room.lensesUnplugged = false;
    evening.recovers();
}

TEST_CASE("faults of a show: the projector's display is unplugged, and the board makes its own white") {
    Playing evening;
    evening.room.unplugDisplay();
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "(HDMI-2) is gone. Check its cable and its power. The projector shows its own white."),
                  read);
    evening.endsLitAndAtRest();
    CHECK(evening.room.bench.board.draws(evening.room.bench.now_ns()));
    CHECK(evening.room.line("display").health == DeviceHealth::unplugged);
    CHECK(evening.room.line("projector").health == DeviceHealth::well);
    CHECK_FALSE(evening.room.played(show()));  // TAKE finds nothing to play on, and leaves the room lit
    evening.endsLitAndAtRest();
    evening.room.plugDisplay();
    evening.recovers();
    CHECK_FALSE(evening.room.bench.board.draws(evening.room.bench.now_ns()));
    CHECK_FALSE(evening.room.beats(15));
}

TEST_CASE("faults of a show: the video cable is pulled at the projector's end, which the computer does not see") {
    Playing evening;
    evening.room.bench.board.unplugVideo(evening.room.bench.now_ns());
    const std::string read = evening.reads();
    CHECK_MESSAGE(contains(read, "The projector shows its own white."), read);
    evening.endsLitAndAtRest();
    const auto again = evening.room.played(show());
    REQUIRE_FALSE(again);
    CHECK_MESSAGE(contains(again.error().what, "gets no video although its display is there"), again.error().what);
    evening.endsLitAndAtRest();
    evening.room.bench.board.plugVideo({912, 1140, 60.0}, evening.room.bench.now_ns());
    evening.recovers();
}

TEST_CASE("faults of a start: the board is left in its own white, which becomes white video first") {
    StageBench room;
    room.stage = nullptr;
    auto left = *dlpc350::LightCrafter::open(std::make_unique<DirectLink>(room.bench), room.bench.clock());
    REQUIRE(left->showOwnWhite());
    left = nullptr;
    room.opened();
    CHECK_FALSE(room.beats(2));
    room.bench.frames(3);
    CHECK(room.white());
    CHECK_FALSE(room.bench.board.draws(room.bench.now_ns()));
    CHECK(room.played(show()));
}

TEST_CASE("faults of a start: the board runs patterns of somebody else, which become white first") {
    StageBench room;
    REQUIRE(room.played(show()));
    REQUIRE(room.bench.board.running());
    room.stage = nullptr;   // makes safe light; another program then starts its own patterns
    room.bench.frames(60);  // until the board has locked to its video again
    auto other = *dlpc350::LightCrafter::open(std::make_unique<DirectLink>(room.bench), room.bench.clock());
    const auto theirs = other->start(dlpc350::evenSequence(8, 3, 2083.0_us));
    REQUIRE_MESSAGE(theirs, (theirs ? "" : theirs.error().what));
    room.opened();
    CHECK_FALSE(room.beats(2));
    room.bench.frames(3);
    CHECK(room.white());
    CHECK_FALSE(room.bench.board.running());
    CHECK(room.line("projector").health == DeviceHealth::well);
    CHECK(room.played(show()));
}

TEST_CASE("faults of a start: no permission and in use are read as they are, with white and rest for all others") {
    for (const std::string why :
         {"No permission to open DLPC350 (0451:6401) at 1-2 (/dev/bus/usb/001/004). Install the project's udev rules.",
          "DLPC350 (0451:6401) at 1-2 is in use by dlp_gui (process 77). Close that and try again."}) {
        StageBench room;
        room.boardRefusal = Error{Fault::device, why};
        const auto started = room.played(show());
        REQUIRE_FALSE(started);
        CHECK(contains(started.error().what, why));
        CHECK(room.line("projector").health == DeviceHealth::silent);
        CHECK(room.line("projector").line == why);
        CHECK(room.lensesRest());
        CHECK(room.white());
        room.boardRefusal.reset();
        room.beats(12);
        CHECK_FALSE(room.beats(3));
        CHECK(room.played(show()));
    }
}

TEST_CASE("faults of a show: a silent board keeps the lenses from rest only until it is noticed") {
    std::optional<double> rested;  // first: what follows makes safe light when it goes
    Playing evening;
    evening.room.bench.board.setFaults({{Mishap::silence}});
    const double from = evening.room.seconds();
    evening.room.bench.meanwhile = [&, before = evening.room.bench.meanwhile] {
        before();
        if (!rested && evening.room.lensesRest()) rested = evening.room.seconds();
    };
    (void)evening.room.beats(15);
    REQUIRE(rested);
    // A beat asks within 1 s at the latest and gives up after half of one; then white (two frames) and the ramp.
    CHECK(*rested - from < 1.0 + 0.5 + 0.25);

    // When the display is lost too, the board is asked first, briefly.
    Playing both;
    both.room.bench.board.setFaults({{Mishap::silence}});
    both.room.unplugDisplay();
    const double lost = both.room.seconds();
    rested.reset();
    both.room.bench.meanwhile = [&, before = both.room.bench.meanwhile] {
        before();
        if (!rested && both.room.lensesRest()) rested = both.room.seconds();
    };
    (void)both.room.beats(15);
    REQUIRE(rested);
    CHECK(*rested - lost < 0.1 + 0.25 + 0.25);
}
