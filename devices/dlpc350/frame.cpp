#include "devices/dlpc350/frame.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <map>
#include <string>

namespace ilf::devices::dlpc350 {
namespace {

constexpr std::size_t kTilePixels = static_cast<std::size_t>(kTile) * kTile;

/// A tile of the frame, colour by colour. Planes 0-7 are green, 8-15 red, 16-23 blue (planesOf).
struct ColourTile {
    alignas(64) std::array<std::array<std::uint8_t, kTilePixels>, 3> colour{};
    const std::array<std::uint8_t, kTilePixels>& green() const { return colour[0]; }
    const std::array<std::uint8_t, kTilePixels>& red() const { return colour[1]; }
    const std::array<std::uint8_t, kTilePixels>& blue() const { return colour[2]; }
};

const Box<Tile>& slotTile(const Program& program, std::size_t slot, int column, int row) {
    const int image = program.imageOfSlot[slot];
    if (image == Program::kDark) return uniformTile(0);
    return program.images[static_cast<std::size_t>(image)].tile(column, row);
}

constexpr std::uint64_t everyByte(unsigned value) { return 0x0101010101010101U * std::uint64_t{value & 0xFFU}; }

/// Codes into planes `planes.first` upwards; they may lie across two colours. Eight pixels at once: shifts of single
/// bytes would be widened to 32 bits each.
void addPlanes(const std::array<std::uint8_t, kTilePixels>& codes, Planes planes, ColourTile& to) {
    for (int colour = planes.first / 8; colour * 8 < planes.first + planes.count; ++colour) {
        std::uint8_t* const bytes = to.colour[static_cast<std::size_t>(colour)].data();
        const int shift = planes.first - 8 * colour;
        const std::uint64_t kept = everyByte(shift >= 0 ? 0xFFU << shift : 0xFFU >> -shift);
        for (std::size_t i = 0; i < kTilePixels; i += 8) {
            std::uint64_t code = 0, old = 0;
            std::memcpy(&code, codes.data() + i, 8);
            std::memcpy(&old, bytes + i, 8);
            old |= (shift >= 0 ? code << shift : code >> -shift) & kept;
            std::memcpy(bytes + i, &old, 8);
        }
    }
}

void packTile(const Program& program, int depth, int column, int row, VideoPicture& picture) {
    ColourTile tile;
    std::array<std::uint8_t, kTilePixels> codes;
    for (std::size_t slot = 0; slot < program.imageOfSlot.size(); ++slot) {
        const Box<Tile>& light = slotTile(program, slot, column, row);
        if (light.same(uniformTile(0))) continue;
        const Planes planes = planesOf(depth, static_cast<int>(slot));
        if (depth == 1) {
            addLitPixels(*light, static_cast<std::uint8_t>(1 << planes.first % 8),
                         tile.colour[static_cast<std::size_t>(planes.first / 8)].data());
            continue;
        }
        tileCodes(*light, depth, codes.data());
        addPlanes(codes, planes, tile);
    }
    const int width = std::min(kTile, picture.size.width - column * kTile);
    const int height = std::min(kTile, picture.size.height - row * kTile);
    for (int y = 0; y < height; ++y) {
        const auto pixel = static_cast<std::size_t>(row * kTile + y) * static_cast<std::size_t>(picture.size.width) +
                           static_cast<std::size_t>(column * kTile);
        std::uint8_t* to = picture.rgb.data() + 3 * pixel;
        const auto from = static_cast<std::size_t>(y) * kTile;
        for (std::size_t x = from; x < from + static_cast<std::size_t>(width); ++x) {
            *to++ = tile.red()[x];
            *to++ = tile.green()[x];
            *to++ = tile.blue()[x];
        }
    }
}

std::string bits(int depth) { return std::to_string(depth) + (depth == 1 ? " bit" : " bits"); }
std::string inWords(Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

Result<PatternSequence> sequenceFor(const Program& program, int depth) {
    if (const auto ok = checked(program); !ok) return tl::unexpected(ok.error());
    if (program.projector != kRaster)
        return fail(Fault::unsupported, "The program is made for a projector of " + inWords(program.projector) +
                                            "; a LightCrafter 4500 has " + inWords(kRaster) +
                                            ". Set the rig's projector to that and compile again.");
    if (depth < 1 || depth > 8)
        return fail(Fault::outOfRange, "Slots of " + bits(depth) +
                                           " were asked of a LightCrafter 4500; it shows 1 to 8. Choose one of these.");
    const int slots = static_cast<int>(program.imageOfSlot.size());
    if (slots > patternsAFrame(depth))
        return fail(Fault::unsafe, "The program has " + std::to_string(slots) + " slots; a frame holds " +
                                       std::to_string(patternsAFrame(depth)) + " pictures of " + bits(depth) +
                                       ". Use fewer slots or fewer bits.");
    PatternSequence sequence = evenSequence(slots, depth, 1.0 / program.slotRate);
    if (const auto ok = checkedSequence(sequence, 1.0 / program.waveform.rate); !ok) return tl::unexpected(ok.error());
    return sequence;
}

/// Whether a tile of any slot differs. Precondition: as many slots in both.
bool changed(const Program& before, const Program& after, int column, int row) {
    for (std::size_t slot = 0; slot < after.imageOfSlot.size(); ++slot)
        if (!slotTile(before, slot, column, row).same(slotTile(after, slot, column, row))) return true;
    return false;
}

template <class Which>
void packTiles(const Program& program, PackedFrame& frame, Which which) {
    const LightImage& shape = program.images.front();
    for (int row = 0; row < shape.rows(); ++row)
        for (int column = 0; column < shape.columns(); ++column)
            if (which(column, row)) packTile(program, frame.depth, column, row, frame.picture);
}

}  // namespace

Result<PackedFrame> packed(const Program& program, int depth) {
    auto sequence = sequenceFor(program, depth);
    if (!sequence) return tl::unexpected(sequence.error());
    PackedFrame frame{{}, *std::move(sequence), depth};
    frame.picture.rgb.resize(static_cast<std::size_t>(kRaster.width) * static_cast<std::size_t>(kRaster.height) * 3);
    packTiles(program, frame, [](int, int) { return true; });
    return frame;
}

Result<PackedFrame> repacked(PackedFrame former, const Program& before, const Program& after) {
    const bool sameTable = former.sequence.entries.size() == after.imageOfSlot.size() &&
                           before.imageOfSlot.size() == after.imageOfSlot.size() &&
                           before.projector == after.projector && former.picture.size == after.projector;
    if (!sameTable) return packed(after, former.depth);
    auto sequence = sequenceFor(after, former.depth);
    if (!sequence) return tl::unexpected(sequence.error());
    former.sequence = *std::move(sequence);
    packTiles(after, former, [&](int column, int row) { return changed(before, after, column, row); });
    return former;
}

std::vector<LightImage> intendedLight(const Program& program, int depth) {
    std::map<int, LightImage> made{{Program::kDark, LightImage(program.projector)}};
    std::vector<LightImage> slots;
    for (const int image : program.imageOfSlot) {
        if (!made.contains(image)) made[image] = quantised(program.images[static_cast<std::size_t>(image)], depth);
        slots.push_back(made[image]);
    }
    return slots;
}

}  // namespace ilf::devices::dlpc350
