#include "devices/dlpc350/frame_quantised.h"

#include <algorithm>
#include <cassert>

namespace ilf::devices::dlpc350 {
namespace {

template <class Number>
using TileRows = std::array<std::array<Number, kTile>, 8>;

/// Two floors instead of one division a pixel: value q = 255 base + rest, and the threshold adds 1 to base exactly
/// where 128 rest + 255 (2 t + 1) >= 255 * 128. At one bit the rest is the value. Loops without branches over a row,
/// which compilers turn into vector code as long as no number needs more bits than its kind has.
template <class Number>
constexpr TileRows<Number> leastRests() {
    TileRows<Number> least{};
    for (std::size_t y = 0; y < 8; ++y)
        for (std::size_t x = 0; x < kTile; ++x)
            least[y][x] = static_cast<Number>((255 * (127 - 2 * kBayer[y][x & 7U]) + 127) / 128);
    return least;
}
constexpr auto kLeastRest = leastRests<std::uint16_t>();
constexpr auto kLeastLit = leastRests<std::uint8_t>();

/// 2 to 7 bits, so that products stay below 2^15.
void row(const std::uint8_t* from, int depth, int y, std::uint8_t* to) {
    const auto& least = kLeastRest[static_cast<std::size_t>(y & 7)];
    const auto full = static_cast<std::uint16_t>(fullCode(depth));
    for (std::size_t x = 0; x < kTile; ++x) {
        const auto product = static_cast<std::uint16_t>(from[x] * full);
        // product / 255, exact below 65535
        const auto sum = static_cast<std::uint16_t>(product + 1 + (product >> 8));
        const auto base = static_cast<std::uint16_t>(sum >> 8);
        const auto rest = static_cast<std::uint16_t>(product - base * 255);
        const auto more = static_cast<std::uint16_t>(rest >= least[x] ? 1 : 0);
        to[x] = static_cast<std::uint8_t>(base + more);
    }
}

}  // namespace

void tileCodes(const Tile& tile, int depth, std::uint8_t* to) {
    assert(depth >= 1 && depth <= 8);
    if (depth == 8) {
        std::copy(tile.v.begin(), tile.v.end(), to);
        return;
    }
    if (depth == 1) {
        std::fill_n(to, tile.v.size(), std::uint8_t{0});
        addLitPixels(tile, 1, to);
        return;
    }
    for (int y = 0; y < kTile; ++y) {
        const auto at = static_cast<std::size_t>(y) * kTile;
        row(tile.v.data() + at, depth, y, to + at);
    }
}

void addLitPixels(const Tile& tile, std::uint8_t plane, std::uint8_t* to) {
    for (int y = 0; y < kTile; ++y) {
        const auto at = static_cast<std::size_t>(y) * kTile;
        const std::uint8_t* const from = tile.v.data() + at;
        std::uint8_t* const row = to + at;
        const auto& least = kLeastLit[static_cast<std::size_t>(y & 7)];
        for (std::size_t x = 0; x < kTile; ++x) {
            const std::uint8_t lit = from[x] >= least[x] ? plane : std::uint8_t{0};
            row[x] = static_cast<std::uint8_t>(row[x] | lit);
        }
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
