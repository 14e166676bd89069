// Where a scan came to no decoding: what its white and its black picture tell of the light, and of what moved.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/registration/scan_diagnosis.h"

namespace ilf::app {

struct LightMap {
    Image<std::uint8_t> rgb;
    std::vector<QualityColour> legend;
};

/// Where something moved, that is, `again`, when white was shown anew, is not empty: where it looks different. Where
/// next to nothing follows the projector: the white picture, that it be seen what the camera looked at. Else, in the
/// quality map's colours: where the sensor's range ends, where the projector's light is told from other light, hardly,
/// or not at all. Precondition: grey and of one size.
LightMap lightMap(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black, const Image<std::uint8_t>& again);

}  // namespace ilf::app
