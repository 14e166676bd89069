// The program's hash and what is checked before it may reach light.
#include <cmath>
#include <string>

#include "core/compile/program.h"
#include "tests/support/law.h"

namespace {

using namespace ilf;

Program someProgram() {
    Program program;
    program.waveform = idealSine(0.0_D, 0.0_D, 2.2_D, 60.0_Hz, 0.0_s);
    program.projector = {100, 70};
    program.images = {TileGrid({100, 70}, 255), TileGrid({100, 70}, 0)};
    program.imageOfSlot.assign(16, Program::kDark);
    program.imageOfSlot[0] = 0;
    program.imageOfSlot[8] = 1;
    return program;
}

}  // namespace

TEST_CASE("program: its hash changes with any pixel, slot or power, and with nothing else") {
    const Program program = someProgram();
    law("one pixel", [&] {
        Program other = program;
        const int x = *rc::gen::inRange(0, 100), y = *rc::gen::inRange(0, 70);
        const auto image = *rc::gen::inRange<std::size_t>(0, 2);
        Tile tile = *other.images[image].tile(x / kTile, y / kTile);
        tile.at(x % kTile, y % kTile) ^= static_cast<std::uint8_t>(*rc::gen::inRange(1, 256));
        other.images[image].setTile(x / kTile, y / kTile, boxed(tile));
        RC_ASSERT(contentHash(other) != contentHash(program));
        other.images[image] = TileGrid({100, 70}, image == 0 ? 255 : 0);
        RC_ASSERT(contentHash(other) == contentHash(program));
    });
    Program other = program;
    other.imageOfSlot[1] = 0;
    CHECK(contentHash(other) != contentHash(program));
    other = program;
    other.waveform.high += 1e-9_D;
    CHECK(contentHash(other) != contentHash(program));
    other = program;
    std::swap(other.images[0], other.images[1]);
    CHECK(contentHash(other) != contentHash(program));
}

TEST_CASE("program: a good one passes, and each thing wrong with it is named") {
    CHECK(checked(someProgram()));
    const auto refused = [](auto&& spoil) {
        Program program = someProgram();
        spoil(program);
        const auto verdict = checked(program);
        return verdict ? std::string("passed") : verdict.error().what;
    };
    const auto says = [](const std::string& what, const char* word) { return what.find(word) != std::string::npos; };
    CHECK(says(refused([](Program& p) { p.images[1] = TileGrid({64, 64}, 0); }), "size"));
    CHECK(says(refused([](Program& p) { p.imageOfSlot[3] = 2; }), "not there"));
    CHECK(says(refused([](Program& p) { p.imageOfSlot.pop_back(); }), "entry"));
    CHECK(says(refused([](Program& p) { p.slotRate = 1000.0_Hz; }), "multiple"));
    CHECK(says(refused([](Program& p) { p.waveform.high = Dioptre::fromSi(NAN); }), "not a number"));
    CHECK(says(refused([](Program& p) { std::swap(p.waveform.low, p.waveform.high); }), "low end"));
    CHECK(says(refused([](Program& p) { p.waveform.high = 0.0_D; }), "stands still"));
    CHECK(says(refused([](Program& p) { p.imageOfSlot.assign(16, Program::kDark); }), "dark"));
    CHECK(says(refused([](Program& p) { p.images.clear(); }), "no picture"));
}
