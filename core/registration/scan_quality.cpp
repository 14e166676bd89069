#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/registration/scan_diagnosis.h"

namespace ilf {

namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kSure{0, 158, 115}, kUnsure{150, 220, 200}, kDark{30, 30, 30}, kSaturated{240, 228, 66},
    kAmbiguous{230, 159, 0}, kInconsistent{204, 121, 167};

}  // namespace

Image<std::uint8_t> qualityMap(const DecodedScan& decoded) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * decoded.state.pixels().size());
    for (std::size_t n = 0; n < decoded.state.pixels().size(); ++n) {
        const int sure = decoded.confidence.pixels()[n];
        Rgb colour{};
        switch (static_cast<PixelState>(decoded.state.pixels()[n])) {
        case PixelState::decoded:
            for (std::size_t k = 0; k < 3; ++k)
                colour[k] = static_cast<std::uint8_t>((kSure[k] * sure + kUnsure[k] * (255 - sure)) / 255);
            break;
        case PixelState::dark:
            colour = kDark;
            break;
        case PixelState::saturated:
            colour = kSaturated;
            break;
        case PixelState::ambiguous:
            colour = kAmbiguous;
            break;
        case PixelState::inconsistent:
            colour = kInconsistent;
            break;
        }
        rgb.insert(rgb.end(), colour.begin(), colour.end());
    }
    return {decoded.state.size(), 3, std::move(rgb)};
}

std::vector<QualityColour> qualityLegend() {
    return {{kSure, "green: decoded, sure"},
            {kUnsure, "pale green: decoded, less sure"},
            {kDark, "black: shadow, dark surface, or outside the projector's light"},
            {kSaturated, "yellow: brighter than the sensor can tell"},
            {kAmbiguous, "orange: a pattern and its inverse look alike: gloss, light from other surfaces, or an edge"},
            {kInconsistent, "pink: decoded, but unlike all around it, or outside the raster"}};
}

}  // namespace ilf
