// What becomes of 8 bits of light when a picture has fewer bits: ordered dither, as a pure function.
#pragma once

#include <array>
#include <cstdint>

#include "core/compile/program.h"

namespace ilf::devices::dlpc350 {

/// The largest code of a picture of `depth` bits, 1 ... 8: full light.
constexpr int fullCode(int depth) { return (1 << depth) - 1; }

/// Order of the thresholds of the dither, 0 ... 63, by row and column modulo 8 (B. E. Bayer, ICC 1973).
constexpr std::array<std::array<std::uint8_t, 8>, 8> kBayer = [] {
    std::array<std::array<std::uint8_t, 8>, 8> order{};
    for (unsigned y = 0; y < 8; ++y)
        for (unsigned x = 0; x < 8; ++x)
            for (unsigned bit = 0; bit < 3; ++bit) {
                const unsigned ofX = x >> bit & 1U, ofY = y >> bit & 1U;
                order[y][x] = static_cast<std::uint8_t>(order[y][x] | ((ofX ^ ofY) << 1U | ofY) << (4U - 2U * bit));
            }
    return order;
}();

/// The code of `depth` bits that a pixel of light `value` (0 ... 255) gets at `x`, `y`: with q = fullCode(depth),
/// floor(value q / 255 + (kBayer + 1/2) / 64). So
/// - 0 stays dark and 255 full; at 8 bits the code is the value;
/// - each pixel's light, code / q of full, is less than 1 / q away from value / 255;
/// - the mean of any 8x8 block of even light is at most 1 / (128 q) away from it, half of what is promised
///   (1 / (64 q)).
constexpr int codeOf(std::uint8_t value, int depth, int x, int y) {
    const int threshold = kBayer[static_cast<std::size_t>(y & 7)][static_cast<std::size_t>(x & 7)];
    return (value * fullCode(depth) * 128 + 255 * (2 * threshold + 1)) / (255 * 128);
}

/// The codes of a whole tile; its corner lies on a multiple of 8, as all tiles' do. `to` holds kTile * kTile.
void tileCodes(const Tile& tile, int depth, std::uint8_t* to);

/// The same at one bit, for packing: pixels that are lit get the bits of `plane` besides what `to` holds.
void addLitPixels(const Tile& tile, std::uint8_t plane, std::uint8_t* to);

/// The light a projector of `depth` bits shows for `image`: codeOf / fullCode of full light, again as 8 bits. Where
/// fullCode does not divide 255 (3, 5, 6 and 7 bits), writing it as 8 bits rounds by at most 1/510 of full light; the
/// bounds of codeOf hold for the light itself.
LightImage quantised(const LightImage& image, int depth);

}  // namespace ilf::devices::dlpc350
