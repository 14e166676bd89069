// The comparison of intended and received light must be able to fail: each mistake here is made on purpose.
#include <doctest/doctest.h>

#include "tests/devices/endtoend/bench.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::dlpc350;
using namespace ilf::devices::test;

namespace {

/// The bytes of an entry of the pattern table, when this is the message that carries it.
std::uint8_t* entryIn(std::span<std::uint8_t> packet, std::size_t entry) {
    const bool table = packet[0] == 0x40 && packet[4] == 0x34 && packet[5] == 0x1A;
    return table && 6 + 3 * entry + 3 <= packet.size() ? packet.data() + 6 + 3 * entry : nullptr;
}

struct Outcome {
    std::string refusal;  ///< of the start; empty: patterns run
    LightComparison light;
};

/// What comes of a program of 12 slots of 2 bits whose table the cable changes.
Outcome tamperedWith(const TamperingLink::Change& change, bool readTableBack) {
    const Program program = sweepOf(12, 20);
    Bench bench;
    bench.frames(20);
    BringUp bringUp;
    bringUp.readTableBack = readTableBack;
    auto driver = *LightCrafter::open(std::make_unique<TamperingLink>(bench, change), bench.clock(), bringUp);
    const auto frame = packed(program, 2);
    const auto started = driver->start(frame->sequence);
    if (!started) return {started.error().what, {}};
    bench.present(frame->picture);
    bench.frames(4);
    return {"", compared(intendedSweep(program, 2), bench.newestSweep())};
}

void exchangePlanes(VideoPicture& picture, int a, int b) {
    constexpr std::array<std::size_t, 3> kByte{1, 0, 2};  // planes count green, red, blue
    for (std::size_t at = 0; at < picture.rgb.size(); at += 3) {
        std::uint8_t& ofA = picture.rgb[at + kByte[std::size_t(a / 8)]];
        std::uint8_t& ofB = picture.rgb[at + kByte[std::size_t(b / 8)]];
        const bool bitA = (ofA >> a % 8 & 1) != 0, bitB = (ofB >> b % 8 & 1) != 0;
        if (bitA == bitB) continue;
        ofA = static_cast<std::uint8_t>(ofA ^ 1 << a % 8);
        ofB = static_cast<std::uint8_t>(ofB ^ 1 << b % 8);
    }
}

}  // namespace

TEST_CASE("on purpose: a cable that changes nothing gives no differing pixel") {
    const auto outcome = tamperedWith([](std::span<std::uint8_t>) {}, true);
    CHECK(outcome.refusal == "");
    CHECK(outcome.light.same());
    CHECK(outcome.light.slots.size() == 12);
}

TEST_CASE("on purpose: one wrong field of the pattern table is refused when read back, else seen in the light") {
    struct Wrong {
        const char* what;
        std::size_t entry, byte;
        std::uint8_t flip;
    };
    constexpr std::array<Wrong, 6> kWrongs{Wrong{"number", 3, 0, 0x04}, Wrong{"depth", 3, 1, 0x03},
                                           Wrong{"LED", 3, 1, 0x10},    Wrong{"no LED at all", 3, 1, 0x70},
                                           Wrong{"inverted", 3, 2, 1},  Wrong{"buffer swap", 0, 2, 4}};
    for (const Wrong& wrong : kWrongs) {
        INFO(wrong.what);
        const auto flip = [&](std::span<std::uint8_t> packet) {
            if (std::uint8_t* const entry = entryIn(packet, wrong.entry)) entry[wrong.byte] ^= wrong.flip;
        };
        const auto noticed = tamperedWith(flip, true);
        CHECK(noticed.refusal.find("was told entry " + std::to_string(wrong.entry)) != std::string::npos);
        const auto unnoticed = tamperedWith(flip, false);
        if (unnoticed.refusal.empty()) CHECK(unnoticed.light.differingPixels > 0);
    }
}

TEST_CASE("on purpose: any two planes of different slots that change places give differing pixels") {
    const Program program = sweepOf(24, 6);
    const auto frame = packed(program, 1);
    Bench bench;
    bench.frames(20);
    auto driver = *LightCrafter::open(std::make_unique<DirectLink>(bench), bench.clock());
    bench.present(frame->picture);
    REQUIRE(driver->start(frame->sequence));
    const auto intended = intendedSweep(program, 1);
    for (const auto& [a, b] : {std::pair{0, 1}, {7, 8}, {15, 16}, {5, 22}}) {
        VideoPicture exchanged = frame->picture;
        exchangePlanes(exchanged, a, b);
        bench.present(exchanged);
        bench.frames(3);
        const auto found = compared(intended, bench.newestSweep());
        CHECK(found.slots[std::size_t(a)].differingPixels > 0);
        CHECK(found.slots[std::size_t(b)].differingPixels > 0);
        CHECK_FALSE(found.same());
    }
    bench.present(frame->picture);
    bench.frames(3);
    CHECK(compared(intended, bench.newestSweep()).same());
}

TEST_CASE("on purpose: a doctored sequence with two numbers exchanged shows the wrong slots") {
    const Program program = sweepOf(6, 31);
    auto frame = *packed(program, 4);
    std::swap(frame.sequence.entries[1].number, frame.sequence.entries[2].number);
    Bench bench;
    bench.frames(20);
    auto driver = *LightCrafter::open(std::make_unique<DirectLink>(bench), bench.clock());
    bench.present(frame.picture);
    REQUIRE(driver->start(frame.sequence));
    bench.frames(4);
    const auto found = compared(intendedSweep(program, 4), bench.newestSweep());
    CHECK(found.slots[0].differingPixels == 0);
    CHECK(found.slots[1].differingPixels > 0);
    CHECK(found.slots[2].differingPixels > 0);
}

TEST_CASE("on purpose: a frame that sticks is seen once the program changes") {
    Bench bench;
    bench.frames(20);
    auto driver = *LightCrafter::open(std::make_unique<DirectLink>(bench), bench.clock());
    const auto first = *packed(sweepOf(6, 40), 4), second = *packed(sweepOf(6, 41), 4);
    bench.present(first.picture);
    REQUIRE(driver->start(first.sequence));
    bench.frames(4);
    bench.board.setFaults({{emulators::Mishap::stuckFrame}});
    bench.present(second.picture);
    bench.frames(4);
    CHECK(compared(intendedSweep(sweepOf(6, 41), 4), bench.newestSweep()).differingPixels > 0);
}
