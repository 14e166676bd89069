#include "devices/dlpc350/frame_quantised.h"

#include <algorithm>
#include <cassert>

namespace ilf::devices::dlpc350 {
namespace {

/// Two floors instead of one division a pixel: value q = 255 base + rest, and the threshold adds 1 to base exactly
/// where 128 rest + 255 (2 t + 1) >= 255 * 128. Loops without branches over a row, which compilers turn into vector
/// code.
std::array<std::uint16_t, 8> leastRests(int row) {
    std::array<std::uint16_t, 8> least{};
    for (std::size_t x = 0; x < 8; ++x) {
        const int threshold = kBayer[static_cast<std::size_t>(row & 7)][x];
        least[x] = static_cast<std::uint16_t>((255 * (127 - 2 * threshold) + 127) / 128);
    }
    return least;
}

/// One bit: the value against a threshold.
void oneBitRow(const std::uint8_t* from, int row, std::uint8_t* to) {
    std::array<std::uint8_t, kTile> least{};
    const auto rests = leastRests(row);
    for (std::size_t x = 0; x < kTile; ++x)
        least[x] = static_cast<std::uint8_t>(rests[x & 7U]);
    for (std::size_t x = 0; x < kTile; ++x)
        to[x] = from[x] >= least[x] ? 1 : 0;
}

void row(const std::uint8_t* from, int depth, int y, std::uint8_t* to) {
    std::array<std::uint16_t, kTile> least{};
    const auto rests = leastRests(y);
    for (std::size_t x = 0; x < kTile; ++x)
        least[x] = rests[x & 7U];
    const auto full = static_cast<std::uint16_t>(fullCode(depth));
    for (std::size_t x = 0; x < kTile; ++x) {
        const auto product = static_cast<std::uint16_t>(from[x] * full);
        // product / 255, exact below 65535
        const auto base = static_cast<std::uint16_t>((product + 1U + (product >> 8U)) >> 8U);
        const auto rest = static_cast<std::uint16_t>(product - base * 255U);
        to[x] = static_cast<std::uint8_t>(base + (rest >= least[x] ? 1U : 0U));
    }
}

}  // namespace

void tileCodes(const Tile& tile, int depth, std::uint8_t* to) {
    assert(depth >= 1 && depth <= 8);
    if (depth == 8) {
        std::copy(tile.v.begin(), tile.v.end(), to);
        return;
    }
    for (int y = 0; y < kTile; ++y) {
        const auto at = static_cast<std::size_t>(y) * kTile;
        if (depth == 1)
            oneBitRow(tile.v.data() + at, y, to + at);
        else
            row(tile.v.data() + at, depth, y, to + at);
    }
}

LightImage quantised(const LightImage& image, int depth) {
    if (depth == 8) return image;
    const int full = fullCode(depth);
    LightImage made(image.size());
    for (int row = 0; row < image.rows(); ++row)
        for (int column = 0; column < image.columns(); ++column) {
            Tile tile;
            tileCodes(*image.tile(column, row), depth, tile.v.data());
            // 255 code / full is never a half, both being odd or exact, so this is the nearest.
            for (std::uint8_t& value : tile.v)
                value = static_cast<std::uint8_t>((255 * 2 * value + full) / (2 * full));
            made.setTile(column, row, boxed(tile));
        }
    return made;
}

}  // namespace ilf::devices::dlpc350
