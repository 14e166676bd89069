#include <doctest/doctest.h>

#include <deque>

#include "devices/dlpc350/lightcrafter.h"
#include "devices/tape/serial_tape.h"
#include "devices/tape/usb_tape.h"
#include "tests/devices/dlpc350/fake_board.h"

using namespace ilf;
using namespace ilf::devices;
using ilf::devices::test::FakeBoard;
using ilf::devices::test::JumpingClock;

namespace {

const dlpc350::PatternSequence kSlots = dlpc350::evenSequence(24, 1, 694.0_us);

/// A tape of an evening in short: what the board is, a start, a look, a stop.
Tape recorded(bool refuseStart = false) {
    JumpingClock time;
    auto board = std::make_unique<FakeBoard>();
    if (refuseStart) board->refuses.insert(0x1A31);
    auto recorder = std::make_shared<TapeRecorder>(time.clock());
    auto driver =
        *dlpc350::LightCrafter::open(std::make_unique<RecordingLink>(std::move(board), recorder), time.clock());
    CHECK(driver->start(kSlots).has_value() == !refuseStart);
    CHECK(driver->stop());
    return recorder->tape();
}

/// What the same driver says when it meets the tape.
struct Replayed {
    bool started = false;
    std::string why;
    Result<void> finished;
};
Replayed replayed(const Tape& tape, const dlpc350::PatternSequence& slots = kSlots) {
    JumpingClock time;
    auto link = *ReplayLink::of(tape);
    ReplayLink* played = link.get();
    auto driver = *dlpc350::LightCrafter::open(std::move(link), time.clock());
    Replayed result;
    const auto started = driver->start(slots);
    result.started = started.has_value();
    if (!started) result.why = started.error().what;
    (void)driver->stop();
    result.finished = played->finished();
    return result;
}

class TwoTransfers : public FakeBoard {
public:
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint, std::size_t bytes, int,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override {
        for (int i = 0; i < 2; ++i) {
            Bytes buffer(bytes);
            fill(buffer);
        }
        return std::make_unique<Idle>();
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint, std::size_t bytes, int,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override {
        for (std::uint8_t i = 0; i < 2; ++i)
            taken(Bytes(bytes, i));
        return std::make_unique<Idle>();
    }

private:
    class Idle : public UsbStream {
        Result<void> state() const override { return {}; }
    };
};

class ScriptedLine : public SerialLink {
public:
    const std::string& name() const override { return name_; }
    Result<void> send(std::span<const std::uint8_t>, Milliseconds) override { return {}; }
    Result<Bytes> receive(std::size_t, Milliseconds) override {
        if (answers.empty()) return fail(Fault::device, "The line is gone.");
        const Bytes answer = answers.front();
        answers.pop_front();
        return answer;
    }
    std::deque<Bytes> answers;

private:
    std::string name_ = "/dev/ttyACM7";
};

}  // namespace

TEST_CASE("tape: a driver that meets its own tape does the same again") {
    const auto tape = parsedTape(tapeText(recorded()));
    REQUIRE(tape);
    const Replayed again = replayed(*tape);
    CHECK(again.started);
    CHECK(again.finished);
    CHECK((*ReplayLink::of(*tape))->identity() == FakeBoard().identity());
    CHECK((*ReplayLink::of(*tape))->interruptOut() == Endpoint{0x01});
    CHECK((*ReplayLink::of(*tape))->interruptIn() == Endpoint{0x81});
    CHECK(!(*ReplayLink::of(*tape))->bulkOut());
}

TEST_CASE("tape: faults are on the tape and come again") {
    const Replayed again = replayed(*parsedTape(tapeText(recorded(true))));
    CHECK(!again.started);
    CHECK(again.why.find("refused \"pattern table's length\"") != std::string::npos);
    CHECK(again.finished);
}

TEST_CASE("tape: another program is noticed at the first byte that differs") {
    const Tape tape = *parsedTape(tapeText(recorded()));
    const Replayed other = replayed(tape, dlpc350::evenSequence(12, 2, 1388.0_us));
    CHECK(!other.started);
    CHECK(other.why.find("The driver asks for \"out 01\" 40 ") != std::string::npos);
    CHECK(!other.finished);

    Tape shorter = tape;
    shorter.entries.pop_back();
    CHECK(!replayed(shorter).finished);
    CHECK(ReplayLink::of(Tape{}).error().what == "This tape is not of a USB device.");
}

TEST_CASE("tape: control transfers and halts are noted and played") {
    class Answering : public FakeBoard {
    public:
        Result<void> controlOut(const VendorRequest&, std::span<const std::uint8_t>, Milliseconds) override {
            return {};
        }
        Result<Bytes> controlIn(const VendorRequest&, std::size_t, Milliseconds) override { return Bytes{0x08, 0x00}; }
    };
    JumpingClock time;
    auto recorder = std::make_shared<TapeRecorder>(time.clock());
    RecordingLink link(std::make_unique<Answering>(), recorder);
    const Bytes data{1, 2, 3};
    REQUIRE(link.controlOut({0x1A, 5, 6}, data, Milliseconds(10)));
    REQUIRE(link.controlIn({0x44, 0, 0}, 2, Milliseconds(10)));
    REQUIRE(link.clearHalt({0x02}));

    const auto again = *ReplayLink::of(*parsedTape(tapeText(recorder->tape())));
    CHECK(again->controlOut({0x1A, 5, 6}, data, Milliseconds(10)));
    CHECK(*again->controlIn({0x44, 0, 0}, 2, Milliseconds(10)) == Bytes{0x08, 0x00});
    CHECK(again->clearHalt({0x02}));
    CHECK(again->finished());
}

TEST_CASE("tape: streams are noted transfer by transfer, and compared when played") {
    JumpingClock time;
    auto recorder = std::make_shared<TapeRecorder>(time.clock());
    RecordingLink link(std::make_unique<TwoTransfers>(), recorder);
    std::uint8_t next = 0;
    const auto counting = [&next](std::span<std::uint8_t> bytes) {
        for (std::uint8_t& b : bytes)
            b = next++;
    };
    REQUIRE(link.streamOut({0x02}, 4, 2, counting));
    std::size_t came = 0;
    REQUIRE(link.streamIn({0x86}, 3, 2, [&](std::span<const std::uint8_t> bytes) { came += bytes.size(); }));
    CHECK(came == 6);

    // Left out, they are opened all the same, and nothing else is on the tape.
    auto brief = std::make_shared<TapeRecorder>(time.clock());
    RecordingLink without(std::make_unique<TwoTransfers>(), brief, Streamed::leftOut);
    REQUIRE(without.streamOut({0x02}, 4, 2, [](std::span<std::uint8_t>) {}));
    REQUIRE(without.streamIn({0x86}, 3, 2, [&](std::span<const std::uint8_t> bytes) { came += bytes.size(); }));
    CHECK(came == 12);
    CHECK(brief->tape().entries.size() == 2);

    const Tape tape = *parsedTape(tapeText(recorder->tape()));
    const auto same = *ReplayLink::of(tape);
    next = 0;
    CHECK((*same->streamOut({0x02}, 4, 2, counting))->state());
    Bytes taken;
    REQUIRE(same->streamIn({0x86}, 3, 2, [&](std::span<const std::uint8_t> bytes) {
        taken.insert(taken.end(), bytes.begin(), bytes.end());
    }));
    CHECK(taken == Bytes{0, 0, 0, 1, 1, 1});
    CHECK(same->finished());

    const auto other = *ReplayLink::of(tape);
    next = 1;
    const auto stream = other->streamOut({0x02}, 4, 2, counting);
    REQUIRE(stream);
    CHECK((*stream)->state().error().what.find("The driver streams otherwise than line") == 0);
}

TEST_CASE("tape: a serial line's tape is of the same kind") {
    JumpingClock time;
    auto recorder = std::make_shared<TapeRecorder>(time.clock());
    auto line = std::make_unique<ScriptedLine>();
    line->answers = {{'R', 'e', 'a', 'd', 'y', '\r', '\n'}, {}};
    RecordingSerialLink link(std::move(line), recorder);
    const Bytes start{'S', 't', 'a', 'r', 't'};
    REQUIRE(link.send(start, Milliseconds(10)));
    REQUIRE(link.receive(64, Milliseconds(10)));
    REQUIRE(link.receive(64, Milliseconds(10)));
    REQUIRE(!link.receive(64, Milliseconds(10)));

    const Tape tape = *parsedTape(tapeText(recorder->tape()));
    CHECK(!ReplayLink::of(tape));
    const auto again = *ReplaySerialLink::of(tape);
    CHECK(again->name() == "/dev/ttyACM7");
    CHECK(again->send(start, Milliseconds(10)));
    CHECK(*again->receive(3, Milliseconds(10)) == Bytes{'R', 'e', 'a'});
    CHECK(!again->finished());
    CHECK(*again->receive(64, Milliseconds(10)) == Bytes{'d', 'y', '\r', '\n'});
    CHECK(again->receive(64, Milliseconds(10))->empty());
    CHECK(again->receive(64, Milliseconds(10)).error().what == "The line is gone.");
    CHECK(again->finished());
}
