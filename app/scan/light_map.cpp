#include "app/scan/light_map.h"

#include <algorithm>
#include <cassert>

namespace ilf::app {
namespace {

using Colour = std::array<std::uint8_t, 3>;
/// Okabe and Ito's, as in the quality map.
constexpr Colour kTold{0, 158, 115}, kHardly{150, 220, 200}, kNot{30, 30, 30}, kEnd{240, 228, 66};
/// Codes that white is above black where stripes can be told, and where something of the projector's light is left.
constexpr int kClear = 20, kAny = 5;
constexpr int kSensorEnd = 254;

Colour colourOf(int white, int black) {
    if (white >= kSensorEnd) return kEnd;
    const int above = white - black;
    return above >= kClear ? kTold : above >= kAny ? kHardly : kNot;
}

}  // namespace

Image<std::uint8_t> lightMap(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black) {
    assert(white.size() == black.size() && white.channels() == 1 && black.channels() == 1);
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * white.pixels().size());
    for (std::size_t i = 0; i < white.pixels().size(); ++i) {
        const Colour colour = colourOf(white.pixels()[i], black.pixels()[i]);
        rgb.insert(rgb.end(), colour.begin(), colour.end());
    }
    return Image<std::uint8_t>(white.size(), 3, std::move(rgb));
}

std::vector<QualityColour> lightLegend() {
    return {{kTold, "green: white is told from black"},
            {kHardly, "pale green: hardly told"},
            {kNot, "black: not told; no light of the projector's, or other light is stronger"},
            {kEnd, "yellow: brighter than the sensor can tell"}};
}

}  // namespace ilf::app
