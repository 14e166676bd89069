#include "app/scan/light_map.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "devices/scan/pair_proof.h"

namespace ilf::app {
namespace {

using Colour = std::array<std::uint8_t, 3>;
/// Okabe and Ito's, as in the quality map.
constexpr Colour kTold{0, 158, 115}, kHardly{150, 220, 200}, kNot{30, 30, 30}, kEnd{240, 228, 66};
constexpr Colour kMoved{230, 159, 0}, kStill{96, 96, 96}, kSeen{160, 160, 160};
/// Codes that white is above black where stripes can be told, and where something of the projector's light is left.
constexpr int kClear = 20, kAny = 5;
constexpr int kSensorEnd = 254;
/// Of all pixels: with fewer that are told, a map would be a few specks.
constexpr double kHardlyAny = 0.02;

Colour colourOf(int white, int black) {
    if (white >= kSensorEnd) return kEnd;
    const int above = white - black;
    return above >= kClear ? kTold : above >= kAny ? kHardly : kNot;
}

/// `colour(i)` of each pixel.
template <class ColourOf>
Image<std::uint8_t> painted(Size size, ColourOf colour) {
    const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const Colour one = colour(i);
        rgb.insert(rgb.end(), one.begin(), one.end());
    }
    return Image<std::uint8_t>(size, 3, std::move(rgb));
}

bool hardlyAny(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black) {
    std::ptrdiff_t told = 0;  // less those that are darker under white: noise makes as many of both
    for (std::size_t i = 0; i < white.pixels().size(); ++i) {
        const int w = white.pixels()[i], b = black.pixels()[i];
        told += (w >= kSensorEnd || devices::clearlyLit(w, b) ? 1 : 0) - (devices::clearlyLit(b, w) ? 1 : 0);
    }
    return static_cast<double>(told) < kHardlyAny * static_cast<double>(white.pixels().size());
}

}  // namespace

LightMap lightMap(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black,
                  const Image<std::uint8_t>& again) {
    assert(white.size() == black.size() && white.channels() == 1 && black.channels() == 1);
    assert(again.empty() || (again.size() == white.size() && again.channels() == 1));
    const auto w = white.pixels(), b = black.pixels(), a = again.pixels();
    const auto grey = [](std::uint8_t code) { return Colour{code, code, code}; };
    if (!again.empty()) {
        return {painted(white.size(),
                        [&](std::size_t i) {
                            return devices::looksDifferent(w[i], b[i], a[i])
                                       ? kMoved
                                       : grey(static_cast<std::uint8_t>(w[i] / 2));
                        }),
                {{kMoved, "orange: looks different under the same white light than at the beginning"},
                 {kStill, "grey: as it was, or too dark to tell"}}};
    }
    if (hardlyAny(white, black)) {
        return {painted(white.size(), [&](std::size_t i) { return grey(w[i]); }),
                {{kSeen, "what the camera saw while white was shown: next to nothing of it follows the projector"}}};
    }
    return {painted(white.size(), [&](std::size_t i) { return colourOf(w[i], b[i]); }),
            {{kTold, "green: white is told from black"},
             {kHardly, "pale green: hardly told"},
             {kNot, "black: not told; no light of the projector's, or other light is stronger"},
             {kEnd, "yellow: brighter than the sensor can tell"}}};
}

}  // namespace ilf::app
