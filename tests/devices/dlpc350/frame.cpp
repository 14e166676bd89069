#include "devices/dlpc350/frame.h"

#include <chrono>
#include <cmath>
#include <set>

#include "devices/dlpc350/frame_test_pictures.h"
#include "tests/devices/programs.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices::dlpc350;

namespace {

/// A program of the projector's raster with a picture of its own in most slots; dark where the seed says so.
Program sweepOf(int slots, std::uint32_t seed) {
    Program program = test::program(seed, 2.27_D, kRaster);
    program.slotRate = static_cast<double>(slots) * 60.0_Hz;
    program.images.clear();
    program.imageOfSlot.clear();
    for (int i = 0; i < slots; ++i) {
        const auto salt = seed + 7U * static_cast<std::uint32_t>(i);
        const bool dark = i > 0 && salt % 5 == 0;
        program.imageOfSlot.push_back(dark ? Program::kDark : static_cast<int>(program.images.size()));
        if (!dark) program.images.push_back(test::picture(kRaster, salt));
    }
    return program;
}

int slotsAt(int depth) {
    constexpr std::array<int, 9> kSlots{0, 24, 12, 8, 6, 4, 4, 3, 2};
    return kSlots[static_cast<std::size_t>(depth)];
}

/// Bits of a pixel, plane 0 lowest.
std::uint32_t planesAt(const VideoPicture& picture, int x, int y) {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * 912 + static_cast<std::size_t>(x));
    return picture.rgb[at + 1] | std::uint32_t(picture.rgb[at]) << 8U | std::uint32_t(picture.rgb[at + 2]) << 16U;
}

std::string refusal(const Program& program, int depth) {
    const auto frame = packed(program, depth);
    return frame ? "" : frame.error().what;
}

}  // namespace

TEST_CASE("quantisation: the dither's order has every threshold once, and neighbours far apart") {
    std::set<int> seen;
    for (const auto& row : kBayer)
        seen.insert(row.begin(), row.end());
    CHECK(seen.size() == 64);
    CHECK(*seen.rbegin() == 63);
    CHECK(kBayer[0][0] == 0);
    CHECK(kBayer[0][1] == 32);
    CHECK(kBayer[1][1] == 16);
    CHECK(kBayer[1][0] == 48);
}

TEST_CASE("quantisation: black and full stay so, 8 bits are exact, and errors are as small as promised") {
    for (int depth = 1; depth <= 8; ++depth) {
        const int full = fullCode(depth);
        for (int value = 0; value <= 255; ++value) {
            double sum = 0.0, worst = 0.0;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    const int code = codeOf(static_cast<std::uint8_t>(value), depth, x, y);
                    REQUIRE(code >= 0);
                    REQUIRE(code <= full);
                    if (value == 0) REQUIRE(code == 0);
                    if (value == 255) REQUIRE(code == full);
                    if (depth == 8) REQUIRE(code == value);
                    const double error = double(code) / full - value / 255.0;
                    sum += error;
                    worst = std::max(worst, std::abs(error));
                }
            REQUIRE(worst < 1.0 / full);
            REQUIRE(std::abs(sum / 64) <= 1.0 / (128.0 * full) + 1e-12);
        }
    }
}

TEST_CASE("quantisation: whole tiles have the codes of their pixels, at every depth and for every value") {
    for (int depth = 1; depth <= 8; ++depth)
        for (int turn = 0; turn < 4; ++turn) {
            Tile tile, codes;
            for (std::size_t i = 0; i < tile.v.size(); ++i)
                tile.v[i] = static_cast<std::uint8_t>(i / 16 + i * 37 * static_cast<std::size_t>(turn));
            tileCodes(tile, depth, codes.v.data());
            bool same = true;
            for (int y = 0; y < kTile; ++y)
                for (int x = 0; x < kTile; ++x)
                    same = same && codes.at(x, y) == codeOf(tile.at(x, y), depth, x, y);
            CHECK(same);
        }
}

TEST_CASE("quantisation: light as 8 bits is its code's share of full light, to the nearest") {
    const LightImage image = test::picture({100, 70}, 4);
    for (int depth = 1; depth <= 8; ++depth) {
        const LightImage light = quantised(image, depth);
        bool same = true;
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 100; ++x) {
                const int code = codeOf(image.at(x, y), depth, x, y);
                same = same && light.at(x, y) == std::lround(255.0 * code / fullCode(depth));
            }
        CHECK(same);
    }
    CHECK(quantised(image, 8) == image);
}

TEST_CASE("frames: every slot's codes lie in its picture's planes, and nothing lies elsewhere") {
    for (int depth = 1; depth <= 8; ++depth) {
        const Program program = sweepOf(slotsAt(depth), 11);
        const auto frame = packed(program, depth);
        REQUIRE(frame);
        REQUIRE(frame->sequence.entries.size() == program.imageOfSlot.size());
        bool same = true;
        for (int y = 0; y < kRaster.height; y += 3)
            for (int x = 0; x < kRaster.width; x += 5) {
                std::uint32_t wanted = 0;
                for (std::size_t slot = 0; slot < program.imageOfSlot.size(); ++slot) {
                    const int image = program.imageOfSlot[slot];
                    if (image == Program::kDark) continue;
                    const std::uint8_t value = program.images[std::size_t(image)].at(x, y);
                    wanted |= std::uint32_t(codeOf(value, depth, x, y)) << planesOf(depth, int(slot)).first;
                }
                same = same && planesAt(frame->picture, x, y) == wanted;
            }
        CHECK(same);
    }
}

TEST_CASE("frames: the table has one entry a slot in time order, and does not depend on the pictures") {
    const auto frame = packed(sweepOf(24, 3), 1);
    REQUIRE(frame);
    CHECK(frame->sequence == evenSequence(24, 1, 1.0 / 1440.0_Hz));
    CHECK(packed(sweepOf(24, 90), 1)->sequence == frame->sequence);
    CHECK(checkedSequence(frame->sequence, 1.0 / 60.0_Hz));
}

TEST_CASE("frames: what cannot be packed is refused in words") {
    CHECK(
        refusal(test::program(1), 1) ==
        "The program is made for a projector of 200x130; a LightCrafter 4500 has 912x1140. Set the rig's projector to "
        "that and compile again.");
    CHECK(refusal(sweepOf(16, 1), 2) ==
          "The program has 16 slots; a frame holds 12 pictures of 2 bits. Use fewer slots or fewer bits.");
    CHECK(refusal(sweepOf(3, 1), 8).find("8 bits take at least 8333 us") != std::string::npos);
    CHECK(refusal(sweepOf(2, 1), 9).find("it shows 1 to 8") != std::string::npos);
    CHECK(refusal(sweepOf(2, 1), 0).find("it shows 1 to 8") != std::string::npos);
    Program broken = sweepOf(4, 1);
    broken.imageOfSlot[1] = 99;
    CHECK(refusal(broken, 4).find("picture that is not there") != std::string::npos);
}

TEST_CASE("frames: packing what changed gives the frame packed afresh") {
    law("repacked is packed, bit by bit", [] {
        const int depth = *rc::gen::inRange(1, 9);
        const Program before = sweepOf(slotsAt(depth), *rc::gen::inRange(0U, 1000U));
        Program after = before;
        const int kind = *rc::gen::inRange(0, 4);
        for (int dabs = *rc::gen::inRange(0, 4); dabs > 0; --dabs) {
            auto& image = after.images[*rc::gen::inRange(std::size_t(0), after.images.size())];
            Tile tile;
            tile.v.fill(*rc::gen::arbitrary<std::uint8_t>());
            tile.v[5] = 9;
            image.setTile(*rc::gen::inRange(0, image.columns()), *rc::gen::inRange(0, image.rows()), boxed(tile));
        }
        if (kind == 1) after.imageOfSlot.back() = Program::kDark;
        if (kind == 2) std::rotate(after.imageOfSlot.begin(), after.imageOfSlot.begin() + 1, after.imageOfSlot.end());
        if (kind == 3) after = sweepOf(2, 5);
        if (!checked(after)) return;
        const auto former = packed(before, depth);
        const auto now = repacked(*former, before, after);
        RC_ASSERT(now.has_value());
        RC_ASSERT(*now == *packed(after, depth));
    });
}

TEST_CASE("frames: a frame of 24 pictures without one even tile is packed in milliseconds") {
    Program program = sweepOf(24, 1);
    for (LightImage& image : program.images)
        for (int row = 0; row < image.rows(); ++row)
            for (int column = 0; column < image.columns(); ++column) {
                Tile tile;
                for (std::size_t i = 0; i < tile.v.size(); ++i)
                    tile.v[i] = static_cast<std::uint8_t>(i * 7 + std::size_t(row * column));
                image.setTile(column, row, boxed(tile));
            }
    // The best of some, since others use the machine too; generous, so that only a slip of a magnitude fails.
    auto best = std::chrono::nanoseconds::max();
    for (int tries = 0; tries < 5; ++tries) {
        const auto from = std::chrono::steady_clock::now();
        REQUIRE(packed(program, 1));
        best = std::min<std::chrono::nanoseconds>(best, std::chrono::steady_clock::now() - from);
    }
    MESSAGE("24 slots of 1 bit: ", best.count() / 1000, " us");
    CHECK(best < std::chrono::seconds(1));
}

TEST_CASE("frames: what a sweep intends has one image a slot, dark ones too") {
    const Program program = sweepOf(12, 2);
    const auto intended = intendedLight(program, 2);
    REQUIRE(intended.size() == 12);
    for (std::size_t slot = 0; slot < 12; ++slot) {
        const int image = program.imageOfSlot[slot];
        CHECK(intended[slot] ==
              (image == Program::kDark ? LightImage(kRaster) : quantised(program.images[std::size_t(image)], 2)));
    }
}

TEST_CASE("test pictures: white is every plane everywhere") {
    const VideoPicture white = whitePicture();
    CHECK(white.rgb.size() == 912U * 1140U * 3U);
    CHECK(std::ranges::all_of(white.rgb, [](std::uint8_t value) { return value == 255; }));
}

TEST_CASE("test pictures: each plane lights its own cell and no other, and no two look alike") {
    const PackedFrame frame = identificationFrame();
    CHECK(checkedSequence(frame.sequence, 1.0 / 60.0_Hz));
    std::set<std::vector<bool>> looks;
    for (int plane = 0; plane < kPlanesAFrame; ++plane) {
        const auto cell = identificationCell(plane);
        bool outside = false;
        std::vector<bool> look;
        for (int y = 0; y < kRaster.height; ++y)
            for (int x = 0; x < kRaster.width; ++x) {
                const bool lit = (planesAt(frame.picture, x, y) >> plane & 1U) != 0;
                if (x >= cell.x0 && x < cell.x1 && y >= cell.y0 && y < cell.y1)
                    look.push_back(lit);
                else
                    outside = outside || lit;
            }
        CHECK_FALSE(outside);
        CHECK(looks.insert(look).second);
    }
}

TEST_CASE("test pictures: the figure 10 reads as a one and a zero") {
    const PackedFrame frame = identificationFrame();
    const auto cell = identificationCell(10);
    const auto lit = [&](int x, int y) { return planesAt(frame.picture, cell.x0 + x, cell.y0 + y) == 1U << 10U; };
    // Middle of the cell at (76, 142); digits 40 wide, 16 apart, 96 high.
    CHECK(lit(28 + 34, 100));       // the one's right stroke
    CHECK_FALSE(lit(28 + 6, 110));  // and no left one
    CHECK(lit(84 + 6, 110));        // the zero's sides
    CHECK(lit(84 + 34, 170));
    CHECK(lit(84 + 20, 98));         // its top
    CHECK_FALSE(lit(84 + 20, 142));  // and no middle
}

TEST_CASE("test pictures: one plane alone is a table the board may have") {
    for (int plane = 0; plane < kPlanesAFrame; ++plane)
        CHECK(checkedSequence(onlyPlane(plane), 1.0 / 60.0_Hz));
}
