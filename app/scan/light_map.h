// Where a scan came to no decoding: what its white and its black picture tell of the light.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/registration/scan_diagnosis.h"

namespace ilf::app {

/// RGB, in the quality map's colours: where the sensor's range ends, where the projector's light is told from other
/// light, hardly, or not at all. Precondition: grey and of one size.
Image<std::uint8_t> lightMap(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black);
std::vector<QualityColour> lightLegend();

}  // namespace ilf::app
