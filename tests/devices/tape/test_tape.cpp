#include "devices/tape/tape.h"

#include <filesystem>
#include <fstream>

#include "devices/tape/tape_player.h"
#include "devices/tape/tape_recorder.h"
#include "tests/support/fuzz.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

const std::string kText = "illuminatedfocus tape 1\n"
                          "about link usb\n"
                          "about product-name LightCrafter of the bench\n"
                          "0.001250 out 01 : C0 11 02\n"
                          "0.002500 in 81 : C0\n"
                          "2.003000 in 81 failed : It ran out of time. |\n"
                          "2.004000 out 01 failed : Gone : or | stuck. | 01 FF\n"
                          "2.005000 control-out 1B 0000 0001 :\n";

}  // namespace

TEST_CASE("tape: a tape written by hand is read, and written as it was") {
    const auto tape = parsedTape(kText);
    REQUIRE(tape);
    CHECK(tape->of("product-name") == "LightCrafter of the bench");
    CHECK(tape->of("nothing").empty());
    REQUIRE(tape->entries.size() == 5);
    CHECK(tape->entries[0].bytes == std::vector<std::uint8_t>{0xC0, 0x11, 0x02});
    CHECK(tape->entries[0].line == 4);
    CHECK(tape->entries[0].at.in(1.0_ms) == doctest::Approx(1.25));
    CHECK(tape->entries[2].failure == "It ran out of time.");
    CHECK(tape->entries[3].failure == "Gone : or | stuck.");
    CHECK(tape->entries[3].bytes == std::vector<std::uint8_t>{0x01, 0xFF});
    CHECK(tape->entries[4].where == "1B 0000 0001");
    CHECK(tapeText(*tape) == kText);
}

TEST_CASE("tape: what is no tape is refused with the line") {
    CHECK(parsedTape("").error().what == "This is no tape: its first line is not \"illuminatedfocus tape 1\".");
    const auto refusal = [](const std::string& line) {
        return parsedTape("illuminatedfocus tape 1\n" + line).error().what;
    };
    CHECK(refusal("0.1 out 01 C0") == "Line 2 of the tape has no colon.");
    CHECK(refusal("x out 01 : C0") == "Line 2 of the tape does not begin with a time.");
    CHECK(refusal("0.1 :") == "Line 2 of the tape does not begin with a time and a word.");
    CHECK(refusal("0.1 out : C") == "Line 2 of the tape has something else than pairs of hexadecimal digits.");
    CHECK(refusal("0.1 out : CG") == "Line 2 of the tape has something else than pairs of hexadecimal digits.");
    CHECK(refusal("about key") == "Line 2 of the tape has no value.");
    CHECK(refusal("0.1 out failed : no bar") ==
          "Line 2 of the tape does not end with | and the bytes that were to be sent.");
}

TEST_CASE("tape: no text makes the reader crash, and every truncation of a tape is read or refused in words") {
    law("random text", [](const std::string& text) {
        const auto tape = parsedTape("illuminatedfocus tape 1\n" + text);
        return tape || !tape.error().what.empty();
    });
    for (Fuzz fuzz; fuzz.goesOn();) {
        std::string text = kText;
        fuzz.damage(text);
        const auto tape = parsedTape(text);
        REQUIRE((tape || !tape.error().what.empty()));
    }
    for (std::size_t cut = 0; cut <= kText.size(); ++cut) {
        const auto tape = parsedTape(kText.substr(0, cut));
        CHECK((tape || !tape.error().what.empty()));
    }
}

TEST_CASE("tape: any tape survives its file") {
    law("entries come back", [] {
        Tape tape;
        tape.about.emplace_back("path", "1-2.3");
        for (int i = *rc::gen::inRange(0, 6); i > 0; --i) {
            TapeEntry entry;
            entry.at = Second::fromSi(*rc::gen::inRange(0, 1'000'000) * 1e-6);
            entry.what = "in";
            entry.where = *rc::gen::element<std::string>("", "81", "1B 0000 0001");
            entry.bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
            entry.failed = *rc::gen::arbitrary<bool>();
            if (entry.failed) entry.failure = *rc::gen::element<std::string>("Gone.", "", "a | b : c", "two\nlines");
            tape.entries.push_back(entry);
        }
        const auto again = parsedTape(tapeText(tape));
        RC_ASSERT(again.has_value());
        RC_ASSERT(again->about == tape.about);
        RC_ASSERT(tapeText(*again) == tapeText(tape));
        RC_ASSERT(again->entries.size() == tape.entries.size());
        for (std::size_t i = 0; i < tape.entries.size(); ++i)
            RC_ASSERT(again->entries[i].bytes == tape.entries[i].bytes);
    });
}

TEST_CASE("tape: files are saved, loaded, and named in errors") {
    const auto file = std::filesystem::temp_directory_path() / "ilf-test-tape.txt";
    REQUIRE(saveTape(*parsedTape(kText), file));
    CHECK(tapeText(*loadTape(file)) == kText);
    std::ofstream(file) << "something";
    CHECK(loadTape(file).error().what.find(file.string()) == 0);
    std::filesystem::remove(file);
    CHECK(loadTape(file).error().fault == Fault::notFound);
    CHECK(saveTape({}, "/nowhere/tape").error().fault == Fault::cannotWrite);
}

TEST_CASE("tape: a recorder with a file has every line there as soon as it is noted, and says where it cannot write") {
    const auto file = std::filesystem::temp_directory_path() / "ilf-test-recorded.tape";
    std::chrono::nanoseconds time{0};
    const Clock clock{[&] { return time; }, [&](std::chrono::nanoseconds t) { time += t; }};
    const auto recorder = *TapeRecorder::into(file, clock);
    recorder->about("path", "1-2");
    recorder->about("path", "1-9");  // opened once more
    time += std::chrono::milliseconds(250);
    recorder->succeeded("out", "01", std::vector<std::uint8_t>{0xC0, 0x11});
    recorder->failed("in", "81", {}, {Fault::device, "Silence."});
    const auto tape = loadTape(file);  // while it goes on
    REQUIRE(tape);
    CHECK(tape->about == std::vector<std::pair<std::string, std::string>>{{"path", "1-2"}});
    REQUIRE(tape->entries.size() == 2);
    CHECK(tape->entries[0].at.si() == doctest::Approx(0.25));
    CHECK(tape->entries[0].bytes == std::vector<std::uint8_t>{0xC0, 0x11});
    CHECK(tape->entries[1].failure == "Silence.");
    CHECK(recorder->tape().entries.empty());
    CHECK_FALSE(recorder->full());
    std::filesystem::remove(file);
    const auto refused = TapeRecorder::into("/nowhere/x.tape", clock);
    CHECK(refused.error().fault == Fault::cannotWrite);
    CHECK(refused.error().what.starts_with("The tape /nowhere/x.tape cannot be written."));
    const auto disk = *TapeRecorder::into("/dev/null", clock);
    CHECK_FALSE(disk->full());
    CHECK_FALSE(TapeRecorder::into("/dev/full", clock));
}

TEST_CASE("tape: playing is strict, and an error names the line") {
    const std::vector<std::uint8_t> sent{0xC0, 0x11, 0x02}, other{0xC0, 0x11, 0x03};
    TapePlayer right(*parsedTape(kText));
    REQUIRE(right.nextSent("out", "01", sent));
    CHECK(right.finished().error().what ==
          "The driver did not ask for \"in 81\", line 5 of the tape, and what follows.");
    CHECK(*right.next("in", "81") == std::vector<std::uint8_t>{0xC0});
    CHECK(right.next("in", "81").error().what == "It ran out of time.");
    CHECK(right.nextSent("out", "01", std::vector<std::uint8_t>{0x01, 0xFF}).error().what == "Gone : or | stuck.");
    REQUIRE(right.nextSent("control-out", "1B 0000 0001", {}));
    CHECK(right.finished());
    CHECK(right.next("in", "81").error().what == "The tape has ended, but the driver asks for \"in 81\".");

    TapePlayer wrong(*parsedTape(kText));
    const std::string why = wrong.nextSent("out", "01", other).error().what;
    CHECK(why == "The driver asks for \"out 01\" C0 11 03, but line 4 of the tape has \"out 01\" C0 11 02.");
    CHECK(wrong.nextSent("out", "01", sent).error().what == why);  // and it stays so
    CHECK(wrong.finished().error().what == why);
}

TEST_CASE("tape: a recorder notes times from its beginning, from any thread's point of view in order") {
    std::chrono::nanoseconds time{5'000'000'000};
    TapeRecorder recorder({[&] { return time; }, [&](std::chrono::nanoseconds t) { time += t; }});
    time += std::chrono::milliseconds(250);
    recorder.succeeded("out", "", std::vector<std::uint8_t>{1});
    recorder.failed("in", "", {}, {Fault::device, "Silence."});
    const Tape tape = recorder.tape();
    REQUIRE(tape.entries.size() == 2);
    CHECK(tape.entries[0].at.si() == doctest::Approx(0.25));
    CHECK(tape.entries[1].failure == "Silence.");
    CHECK(!recorder.full());
    const std::vector<std::uint8_t> much(8u << 20);
    for (int i = 0; i < 9; ++i)
        recorder.succeeded("out", "", much);
    CHECK(recorder.full());
    CHECK(recorder.tape().entries.size() < 10);
}
