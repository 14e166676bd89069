#include "devices/dlpc350/sequence.h"

#include "core/document/rig.h"
#include "core/plan/projector.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices::dlpc350;

namespace {

constexpr Second kFrame = 16666.67_us;

std::string refusal(const PatternSequence& sequence, Second frame = kFrame) {
    const auto checked = checkedSequence(sequence, frame);
    return checked ? "" : checked.error().what;
}

}  // namespace

TEST_CASE("pattern tables: bit planes as the reference's table has them") {
    // G0 ... G7 = 0 ... 7, R0 ... R7 = 8 ... 15, B0 ... B7 = 16 ... 23.
    CHECK(planesOf(1, 8) == Planes{8, 1});
    CHECK(planesOf(2, 0) == Planes{0, 2});    // G1 G0
    CHECK(planesOf(2, 11) == Planes{22, 2});  // B7 B6
    CHECK(planesOf(3, 2) == Planes{6, 3});    // R0 G7 G6
    CHECK(planesOf(3, 5) == Planes{15, 3});   // B1 B0 R7
    CHECK(planesOf(5, 0) == Planes{1, 5});    // G5 ... G1
    CHECK(planesOf(5, 1) == Planes{7, 5});    // R3 ... R0, G7
    CHECK(planesOf(5, 2) == Planes{13, 5});   // B1 B0 R7 ... R5
    CHECK(planesOf(5, 3) == Planes{19, 5});   // B7 ... B3
    CHECK(planesOf(6, 3) == Planes{18, 6});
    CHECK(planesOf(7, 1) == Planes{9, 7});  // R7 ... R1
    CHECK(planesOf(8, 2) == Planes{16, 8});
}

TEST_CASE("pattern tables: every depth's pictures stay apart and within the frame") {
    for (int depth = 1; depth <= 8; ++depth)
        for (int n = 0; n < patternsAFrame(depth); ++n) {
            CHECK(planesOf(depth, n).count == depth);
            CHECK(planesOf(depth, n).first + depth <= kPlanesAFrame);
            if (n > 0) CHECK(planesOf(depth, n).first >= planesOf(depth, n - 1).first + depth);
        }
}

TEST_CASE("pattern tables: the streaming table of 24 slots") {
    const PatternSequence sequence = evenSequence(24, 1, 694.0_us);
    REQUIRE(checkedSequence(sequence, kFrame));
    const auto bytes = lutBytes(lutOf(sequence, true));
    REQUIRE(bytes.size() == 72);
    CHECK(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 6) ==
          std::vector<std::uint8_t>{0x01, 0x71, 0x04, 0x07, 0x71, 0x00});
    CHECK(bytes[69] == 0x5F);  // 23 << 2 | 3
    CHECK(lutBytes(lutOf(sequence, false))[2] == 0x00);
}

TEST_CASE("pattern tables: what the planner counts on fits") {
    for (int bits = 1; bits <= 8; ++bits) {
        Rig rig;
        rig.kind = ProjectorKind::lightCrafter4500;
        rig.bits = bits;
        const int slots = mostSlots(rig);
        const Second exposure = Second::fromSi(1.0 / 60.0 / slots);
        CHECK(refusal(evenSequence(slots, bits, exposure), Second::fromSi(1.0 / 60.0)).empty());
    }
}

TEST_CASE("pattern tables: what the tables forbid is refused in words") {
    CHECK(refusal({}) == "The pattern table is empty: a sweep needs at least one slot.");
    // 60.01 Hz, as the board measures in steps of 0.01: what is sent fits, what is meant would not by 3 us.
    CHECK(refusal(evenSequence(24, 1, Second::fromSi(1.0 / 1440.0)), Second::fromSi(1.0 / 60.01)).empty());
    CHECK(
        refusal(evenSequence(24, 1, 694.0_us), 16.0_ms) ==
        "The frame that starts with entry 0 of the pattern table is lit for 16656 us; the video's frame, as measured, "
        "lasts 16000 us. Use fewer or shorter slots.");
    CHECK(refusal(evenSequence(2, 8, 8000.0_us)) == "Entry 0 of the pattern table is lit for 8000 us; 8 bits take at "
                                                    "least 8333 us. Use fewer bits or fewer slots.");
    CHECK(refusal(evenSequence(9, 3, 1800.0_us)).find("they count 0 to 7") != std::string::npos);

    PatternSequence again = evenSequence(24, 1, 300.0_us);
    again.entries.push_back({1, 0, Led::white, Trigger::none, 300.0_us});
    CHECK(refusal(again).find("needs 25 bit planes; there are 24") != std::string::npos);
    again.entries.back().number = kBlackPattern;
    CHECK(refusal(again).empty());

    PatternSequence frames;
    for (int i = 0; i < 129; ++i)
        frames.entries.push_back({1, 0, Led::white, Trigger::externalPositive, 300.0_us});
    CHECK(refusal(frames).find("has 129 entries; the board holds 128") != std::string::npos);
    frames.entries.pop_back();
    CHECK(refusal(frames).empty());

    PatternSequence untriggered = evenSequence(2, 1, 300.0_us);
    untriggered.entries.front().trigger = Trigger::none;
    CHECK(refusal(untriggered).find("must follow VSYNC") != std::string::npos);
    PatternSequence uneven = evenSequence(2, 1, 300.0_us);
    uneven.entries.back().exposure = 400.0_us;
    CHECK(refusal(uneven).find("equally long") != std::string::npos);
    PatternSequence internal = evenSequence(2, 1, 300.0_us);
    internal.entries.back().trigger = Trigger::internal;
    CHECK(refusal(internal).find("does not exist with live video") != std::string::npos);
    PatternSequence deep = evenSequence(1, 1, 9000.0_us);
    deep.entries.front().depth = 9;
    CHECK(refusal(deep).find("9 bits; pictures have 1 to 8") != std::string::npos);
    CHECK(refusal(evenSequence(1, 1, 300.0_us), 0.0_s).find("not measured") != std::string::npos);
}

TEST_CASE("pattern tables: whatever is asked, what passes fits") {
    law("accepted tables fit into frame and planes", [] {
        PatternSequence sequence = evenSequence(*rc::gen::inRange(0, 30), *rc::gen::inRange(1, 9),
                                                Second::fromSi(*rc::gen::inRange(100, 9000) * 1e-6));
        for (PatternEntry& entry : sequence.entries)
            if (*rc::gen::inRange(0, 6) == 0) entry.trigger = Trigger::externalPositive;
        if (!checkedSequence(sequence, kFrame)) return;
        Second time;
        int planes = 0;
        for (const PatternEntry& entry : sequence.entries) {
            if (entry.trigger == Trigger::externalPositive) time = 0.0_s, planes = 0;
            time += entry.exposure;
            planes += entry.depth;
            RC_ASSERT(time <= kFrame + 0.1_us);
            RC_ASSERT(planes <= 24);
            RC_ASSERT(entry.exposure >= shortestExposure(entry.depth) - 0.1_us);
        }
        const auto lut = lutOf(sequence, true);
        RC_ASSERT(parsedLut(lutBytes(lut), lut.size()) == lut);
    });
}
