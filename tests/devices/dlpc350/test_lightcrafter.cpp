#include "devices/dlpc350/lightcrafter.h"

#include <memory>
#include <set>

#include "tests/devices/dlpc350/fake_board.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::dlpc350;
using ilf::devices::test::FakeBoard;
using ilf::devices::test::JumpingClock;

namespace {

/// A driver on a scripted board.
struct Bench {
    explicit Bench(BringUp bringUp = {}) {
        auto owned = std::make_unique<FakeBoard>();
        board = owned.get();
        driver = *LightCrafter::open(std::move(owned), time.clock(), bringUp);
    }
    JumpingClock time;
    FakeBoard* board = nullptr;
    std::unique_ptr<LightCrafter> driver;
};

const PatternSequence kSlots = evenSequence(24, 1, 694.0_us);

std::string whyNot(Bench& bench) {
    const auto started = bench.driver->start(kSlots);
    return started ? "" : started.error().what;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("lightcrafter: a start is the reference's order of operations, byte by byte") {
    Bench bench;
    const auto started = bench.driver->start(kSlots);
    REQUIRE(started);
    CHECK(started->video.refresh.si() == doctest::Approx(60.0));
    CHECK(started->remarks.size() == 1);

    std::string table;
    char entry[8];
    for (int i = 0; i < 24; ++i) {
        std::snprintf(entry, sizeof entry, "%02X71%02X", (i << 2) | (i == 0 ? 1 : 3), i == 0 ? 4 : 0);
        table += entry;
    }
    const std::vector<std::string> wanted{
        "1A24 00", "1A1B 01", "1A22 00",       "1A31 17011700", "1A23 00", "1A29 B6020000B6020000",
        "1A33 02", "1A32 00", "1A34 " + table, "1A33 00",       "1A33 02", "1A32 00",
        "1A33 00", "1A1A 00", "1A24 02",       "1A24 02"};
    CHECK(bench.board->told == wanted);
    CHECK(bench.board->asked.front() == "1A1B");
    CHECK(bench.board->asked[1] == "1A00");
    CHECK(bench.board->asked[2] == "071C");  // locked and measured before anything is changed
    CHECK(bench.board->runs());
    // Two frames after the stop, two busy checks, 100 ms between the starts, two frames more.
    CHECK(std::chrono::duration<double>(bench.time.time).count() ==
          doctest::Approx(4.0 / 60.0 + 0.2 + 0.1).epsilon(0.01));
}

TEST_CASE("lightcrafter: without usable video nothing is touched") {
    Bench dark;
    dark.board->registers[0x071C][0] = 0x01;
    CHECK(contains(whyNot(dark), "has locked on no picture at its HDMI input"));
    CHECK(!dark.board->touched());

    Bench small;
    small.board->registers[0x071C][1] = 0x00;  // 0x0300 = 768 columns
    CHECK(whyNot(small) ==
          "The LightCrafter 4500 at 1-2 gets 768x1140 at 60.00 Hz; slots are shown right only at exactly "
          "912x1140. Set that mode for its display.");
    CHECK(!small.board->touched());

    Bench slow;
    slow.board->registers[0x071C][14] =
        0x3B;  // 0x173B = 59.47 Hz would do, 0x1B3B = 69.71 Hz is too fast for the slots
    slow.board->registers[0x071C][15] = 0x1B;
    CHECK(contains(whyNot(slow), "as measured, lasts 14345 us"));
    CHECK(!slow.board->touched());
}

TEST_CASE("lightcrafter: video is measured once; in pattern mode the board cannot tell") {
    Bench bench;
    REQUIRE(bench.driver->start(kSlots));
    REQUIRE(bench.driver->start(kSlots));
    CHECK(std::count(bench.board->asked.begin(), bench.board->asked.end(), "071C") == 1);

    // Left in pattern mode by another program: to video and back, once.
    Bench left;
    left.board->registers[0x1A1B] = {1};
    REQUIRE(left.driver->start(kSlots));
    CHECK(left.board->told[0] == "1A24 00");
    CHECK(left.board->told[1] == "1A1B 00");
    CHECK(left.board->runs());
}

TEST_CASE("lightcrafter: a change while patterns run stops them, waits two frames and sends the whole table again") {
    Bench bench;
    REQUIRE(bench.driver->start(kSlots));
    bench.board->told.clear();
    const auto before = bench.time.time;
    REQUIRE(bench.driver->start(evenSequence(12, 2, 1388.0_us)));
    CHECK(bench.board->told.front() == "1A24 00");
    CHECK(bench.board->told[1] == "1A22 00");  // already in pattern mode: not switched again
    CHECK(bench.board->told.back() == "1A24 02");
    CHECK(std::chrono::duration<double>(bench.time.time - before).count() > 2.0 / 60.0);
    CHECK(bench.board->registers[0x1A31] == Bytes{0x0B, 1, 0x0B, 0});
}

TEST_CASE("lightcrafter: each setting that reads back otherwise is an error that names it") {
    struct Lie {
        int command;
        Bytes says;
        std::string sentence;
    };
    const std::vector<Lie> lies{
        {0x1A22, {3}, "was told pattern source \"video port\" but says \"flash\""},
        {0x1A31,
         {0x16, 1, 0x17, 0},
         "was told pattern table's length \"24 entries, repeated, TRIG_OUT_2 every 24, 1 image\""},
        {0x1A23, {1}, "was told trigger mode \"VSYNC\" but says \"TRIG_IN_1\""},
        {0x1A29, {0xB6, 2, 0, 0, 0xB7, 2, 0, 0}, "but says \"694 us of 695 us\""},
        {0x1A34, Bytes(72, 0),
         "was told entry 0 of the pattern table \"picture 0 of 1 bit, white, VSYNC, buffer swap\""},
        {0x1A34, Bytes(71, 0), "gave its pattern table back cut short"},
        {0x1A1A, {0x01}, "calls the exposure or the period invalid"},
        {0x1A1A, {0x02}, "calls a pattern number invalid"},
        {0x1A1A, {0x80}, "The check of the pattern table did not end."},
        {0x1A24, {1}, "says they still run"},
        {0x1A0C, {0x00}, "says they are running and its sequencer rests"},
        {0x1A0A, {0x09}, "Buffers were swapped by force"},
        {0x1A0A, {0x41}, "The sequencer gave up"},
        {0x1A1B, {0}, "was told display mode \"pattern\" but says \"video\""},
    };
    for (const Lie& lie : lies) {
        Bench bench;
        bench.board->lies[lie.command] = lie.says;
        const std::string why = whyNot(bench);
        CAPTURE(why);
        CHECK(contains(why, lie.sentence));
        CHECK((contains(why, "ower off and on") || contains(why, " again") || contains(why, "Use fewer") ||
               contains(why, "use fewer") || contains(why, "Check that")));  // what would help
        CHECK(!bench.board->runs());
    }
}

TEST_CASE("lightcrafter: triggers are set and compared only when asked for; LEDs go back to the sequencer") {
    BringUp bringUp;
    bringUp.triggerOut1 = TriggerOut1{0x02, 0xBB, 0xBB};
    bringUp.triggerOut2 = TriggerOut2{0x00, 0xC0};
    Bench bench(bringUp);
    bench.board->registers[0x1A07] = {0x07};
    REQUIRE(bench.driver->start(kSlots));
    const auto& told = bench.board->told;
    CHECK(std::count(told.begin(), told.end(), "1A1D 02BBBB") == 1);
    CHECK(std::count(told.begin(), told.end(), "1A1E 00C0") == 1);
    CHECK(std::count(told.begin(), told.end(), "1A07 08") == 1);

    Bench masked(bringUp);
    masked.board->lies[0x1A1D] = {0x00, 0xBB, 0xBB};
    CHECK(contains(whyNot(masked), "was told TRIG_OUT_1 \"polarity 0x02"));
}

TEST_CASE("lightcrafter: refusals and silence are errors in words, and the board ends stopped") {
    for (const int command : {0x1A1B, 0x1A22, 0x1A31, 0x1A23, 0x1A29, 0x1A33, 0x1A32, 0x1A34, 0x1A1A}) {
        Bench refusing;
        refusing.board->refuses.insert(command);
        CHECK(contains(whyNot(refusing), " refused "));
        CHECK(!refusing.board->runs());
        Bench silent;
        silent.board->ignores.insert(command);
        CHECK(contains(whyNot(silent), " did not answer "));
        CHECK(!silent.board->runs());
        Bench lost;
        lost.board->losesAck.insert(command);
        CHECK(contains(whyNot(lost), "Timed out. If it is plugged in and stays silent, switch its power off and on."));
        CHECK(!lost.board->runs());
    }
}

TEST_CASE("lightcrafter: whichever call fails, there is an error and no pattern runs") {
    int n = 0;
    for (bool fails = true; fails;) {
        Bench bench;
        REQUIRE(bench.driver->findings());  // drains, so that calls counted are those of the start
        bench.board->calls = 0;
        bench.board->failAt = ++n;
        const auto started = bench.driver->start(kSlots);
        fails = bench.board->calls >= n;
        CAPTURE(n);
        if (!fails) {
            CHECK(started);
            continue;
        }
        REQUIRE(!started);
        CHECK(contains(started.error().what, "Injected fault."));
        CHECK((!bench.board->runs() || !bench.board->touched()));
        // And it starts the next time.
        CHECK(bench.driver->start(kSlots));
    }
    CHECK(n > 60);
}

TEST_CASE("lightcrafter: while patterns run, a change whose any call fails leaves them running untouched or stopped") {
    int n = 0;
    for (bool fails = true; fails;) {
        Bench bench;
        REQUIRE(bench.driver->start(kSlots));
        bench.board->told.clear();
        bench.board->calls = 0;
        bench.board->failAt = ++n;
        const auto started = bench.driver->start(evenSequence(12, 2, 1388.0_us));
        fails = bench.board->calls >= n;
        CAPTURE(n);
        CHECK(started.has_value() == !fails);
        if (fails) CHECK((!bench.board->runs() || !bench.board->touched()));
    }
    CHECK(n > 60);
}

TEST_CASE("lightcrafter: unplugged, the error says that nothing is known of its light") {
    Bench bench;
    REQUIRE(bench.driver->measuredVideo());
    bench.board->lies[0x1A22] = {3};
    bench.board->ignores.insert(0x1A24);
    CHECK(contains(whyNot(bench), "It could not be stopped either: its light is not known."));
    bench.board->unplugged = true;
    CHECK(contains(whyNot(bench), "The device is gone."));
}

TEST_CASE("lightcrafter: old replies are drained or thrown away") {
    Bench bench;
    Bytes old(64);
    old[0] = 0x40, old[1] = 1, old[2] = 2, old[4] = 0x24, old[5] = 0x1A;
    bench.board->replies.push_back(old);  // of a program that died; same sequence number as our first
    Bytes manyPackets(64, 0x00);
    manyPackets[0] = 0xC0, manyPackets[1] = 77, manyPackets[2] = 100;
    bench.board->replies.push_back(manyPackets);
    bench.board->replies.push_back(Bytes(64, 0x01));
    REQUIRE(bench.driver->findings());

    // One that comes late is known by its sequence number; its second packet would read as a header.
    bench.board->replies.push_back(manyPackets);
    bench.board->replies.push_back(Bytes(64, 0xFF));
    const auto found = bench.driver->findings();
    REQUIRE(found);
    CHECK(found->version.application == Release{4, 4, 7});
}

TEST_CASE("lightcrafter: findings for a doctor") {
    Bench bench;
    const auto well = bench.driver->findings();
    REQUIRE(well);
    CHECK(well->firmwareTag == "LCR");
    CHECK(well->troubles.empty());
    CHECK(well->video.locked);
    CHECK(!bench.board->touched());

    bench.board->registers[0x1A0A] = {0x00};
    bench.board->registers[0x1A0B] = {0x00};
    bench.board->registers[0x1A0C] = {0x01};
    bench.board->registers[0x071C][0] = 0x00;
    bench.board->refuses.insert(0x1AFF);
    const auto ill = bench.driver->findings();
    REQUIRE(ill);
    CHECK(ill->troubles.size() == 4);
}

TEST_CASE("lightcrafter: the watch asks at most once a second and notices a flip to video") {
    Bench bench;
    REQUIRE(bench.driver->start(kSlots));
    const auto first = bench.driver->watch();
    REQUIRE(first);
    CHECK(first->playing);
    const std::size_t asked = bench.board->asked.size();
    bench.time.time += std::chrono::milliseconds(900);
    CHECK(bench.driver->watch()->playing);
    CHECK(bench.board->asked.size() == asked);

    bench.board->flipToVideo();
    bench.time.time += std::chrono::milliseconds(100);
    const auto flipped = bench.driver->watch();
    REQUIRE(flipped);
    CHECK(!flipped->playing);
    CHECK(flipped->flips == 1);
    REQUIRE(!flipped->troubles.empty());
    CHECK(contains(flipped->troubles.front(), "left pattern mode by itself"));
    CHECK(!bench.board->runs());  // nothing restarts by itself
    REQUIRE(bench.driver->start(kSlots));
    CHECK(bench.driver->watch()->playing);
    CHECK(bench.driver->watch()->flips == 1);

    bench.board->registers[0x1A0A] = {0x09};
    bench.time.time += std::chrono::seconds(1);
    CHECK(!bench.driver->watch()->playing);
    bench.board->unplugged = true;
    bench.time.time += std::chrono::seconds(1);
    CHECK(!bench.driver->watch());
}

TEST_CASE("lightcrafter: LED currents, program mode, bootloader, reset and power are never touched") {
    const std::set<std::string> known{"1203", "1204", "1A00", "1A07", "1A1A", "1A1B", "1A1D", "1A1E",
                                      "1A22", "1A23", "1A24", "1A29", "1A31", "1A32", "1A33", "1A34"};
    BringUp bringUp;
    bringUp.triggerOut1 = TriggerOut1{};
    bringUp.triggerOut2 = TriggerOut2{};
    Bench bench(bringUp);
    bench.board->registers[0x1A07] = {0x07};
    REQUIRE(bench.driver->findings());
    REQUIRE(bench.driver->start(kSlots));
    REQUIRE(bench.driver->watch());
    REQUIRE(bench.driver->showOwnWhite());
    REQUIRE(bench.driver->showVideo());
    bench.board->registers[0x1A0A] = {0x80};
    REQUIRE(!bench.driver->start(kSlots));
    for (const std::string& told : bench.board->told)
        CHECK(known.contains(told.substr(0, 4)));
}

TEST_CASE("lightcrafter: plain video is patterns stopped and the mode changed, once") {
    Bench bench;
    REQUIRE(bench.driver->start(kSlots));
    bench.board->told.clear();
    REQUIRE(bench.driver->showVideo());
    CHECK(bench.board->told == std::vector<std::string>{"1A24 00", "1A1B 00"});
    bench.board->told.clear();
    REQUIRE(bench.driver->showVideo());
    CHECK(bench.board->told == std::vector<std::string>{"1A24 00"});
}

TEST_CASE("lightcrafter: its own white is patterns stopped, the picture set, then chosen; and video again, as it was") {
    Bench bench;
    REQUIRE(bench.driver->start(kSlots));
    bench.board->told.clear();
    REQUIRE(bench.driver->showOwnWhite());
    // 1023 = 0x03FF: red, green, blue, and once more for the background. Test pattern 0 is the solid field; source 1
    // keeps the parallel port's 24 bits (code 1 in bits 5:3).
    CHECK(bench.board->told ==
          std::vector<std::string>{"1A24 00", "1A1B 00", "1204 FF03FF03FF03FF03FF03FF03", "1203 00", "1A00 09"});
    CHECK(bench.driver->watch()->source == Source::testPattern);
    const auto found = bench.driver->findings();
    REQUIRE(found);
    CHECK(found->troubles.empty());
    CHECK(contains(found->remarks.back(), "It shows test pattern instead of video"));

    bench.board->told.clear();
    REQUIRE(bench.driver->showOwnWhite());  // again and again: nothing flickers
    CHECK(bench.board->told == std::vector<std::string>{"1A24 00"});

    bench.board->told.clear();
    REQUIRE(bench.driver->showVideo());
    CHECK(bench.board->told == std::vector<std::string>{"1A24 00", "1A00 08"});
    CHECK(*bench.driver->seesVideo());
    CHECK(bench.driver->watch()->seesVideo);
    bench.board->registers[0x071C][0] = 0x01;
    CHECK_FALSE(*bench.driver->seesVideo());
    bench.time.time += std::chrono::seconds(1);
    CHECK_FALSE(bench.driver->watch()->seesVideo);
}

TEST_CASE(
    "lightcrafter: a start finds the board in a picture of its own and goes back to video, another port is left") {
    using Bytes2 = std::pair<std::uint8_t, std::uint8_t>;
    for (const auto& [left, wanted] : {Bytes2{0x11, 0x10}, Bytes2{0x02, 0x00}, Bytes2{0x0B, 0x0B}}) {
        CAPTURE(int{left});
        Bench bench;
        bench.board->registers[0x1A00] = {left};
        REQUIRE(bench.driver->start(kSlots));
        CHECK(bench.board->registers[0x1A00] == Bytes{wanted});
        CHECK(bench.board->runs());
    }
}

TEST_CASE(
    "lightcrafter: whichever call of its own white fails, there is an error, and no pattern runs once it got to it") {
    for (int n = 1;; ++n) {
        Bench bench;
        REQUIRE(bench.driver->start(kSlots));
        bench.board->calls = 0;
        bench.board->failAt = n;
        const auto shown = bench.driver->showOwnWhite();
        CAPTURE(n);
        if (bench.board->calls < n) {
            CHECK(shown);
            CHECK(n > 16);
            break;
        }
        // A setting that could not be asked is told.
        if (shown) {
            CHECK(bench.board->registers[0x1A00] == Bytes{0x09});
            CHECK(bench.board->registers[0x1203] == Bytes{0});
            CHECK(bench.board->registers[0x1204] == Bytes{255, 3, 255, 3, 255, 3, 255, 3, 255, 3, 255, 3});
        } else {
            CHECK(contains(shown.error().what, "Injected fault."));
        }
        CHECK(bench.driver->showOwnWhite());
        CHECK_FALSE(bench.board->runs());
    }
}

TEST_CASE("lightcrafter: its own white that reads back otherwise is an error that names it") {
    struct Lie {
        int command;
        Bytes says;
        std::string sentence;
    };
    for (const Lie& lie :
         {Lie{0x1A00, {0x08}, "was told input source \"test pattern\" but says \"parallel port\""},
          Lie{0x1203, {7}, "was told test pattern \"one colour\" but says \"pattern 7\""},
          Lie{0x1204, Bytes(12, 0), "\"1023 1023 1023 on 1023 1023 1023\" but says \"0 0 0 on 0 0 0\""}}) {
        Bench bench;
        bench.board->lies[lie.command] = lie.says;
        const auto shown = bench.driver->showOwnWhite();
        REQUIRE_FALSE(shown);
        CHECK_MESSAGE(contains(shown.error().what, lie.sentence), shown.error().what);
    }
}

TEST_CASE("lightcrafter: whatever the board answers, the driver returns") {
    law("random replies to a start", [] {
        Bench bench;
        for (int i = *rc::gen::inRange(0, 40); i > 0; --i)
            bench.board->lies[0x1A00 + *rc::gen::inRange(0, 0x40)] = *rc::gen::arbitrary<Bytes>();
        const auto started = bench.driver->start(kSlots);
        RC_ASSERT(started || !started.error().what.empty());
        if (!started) RC_ASSERT(!bench.board->runs());
        const auto white = bench.driver->showOwnWhite();
        RC_ASSERT(white || !white.error().what.empty());
    });
}
