#include "devices/rig/pattern_frames.h"

#include <doctest/doctest.h>

#include "devices/dlpc350/frame.h"
#include "tests/devices/programs.h"

namespace ilf::devices {
namespace {

Program inFrame(std::uint32_t seed, int slots) {
    auto program = test::program(seed, 2.0_D, dlpc350::kRaster);
    program.slotRate = static_cast<double>(slots) * 60.0_Hz;
    program.imageOfSlot.assign(static_cast<std::size_t>(slots), 0);
    program.imageOfSlot.back() = 1;
    return program;
}

}  // namespace

TEST_CASE("pattern frames: what a stage gets is the program packed, whatever came before") {
    auto frames = patternFrames(1);
    const auto first = inFrame(1, 16);
    for (const auto& program : {first, test::dabbed(first, 7), inFrame(2, 16), inFrame(2, 8), first}) {
        const auto given = frames(program);
        const auto whole = dlpc350::packed(program, 1);
        REQUIRE(given);
        REQUIRE(whole);
        CHECK(given->picture == VideoFrame(whole->picture.size, 3, whole->picture.rgb));
        CHECK(given->sequence == whole->sequence);
    }
    // After a refusal it starts anew.
    CHECK_FALSE(frames(test::program(1)));
    CHECK(frames(first)->picture == VideoFrame(dlpc350::kRaster, 3, dlpc350::packed(first, 1)->picture.rgb));
}

}  // namespace ilf::devices
