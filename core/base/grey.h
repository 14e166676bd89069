// Pictures as one channel of brightness, which is all that markers, textures and scans are told by.
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace ilf {

/// 8 bits, one channel, the picture's size, sRGB-encoded. Weights of Rec. 709 in 1/256.
Image<std::uint8_t> greyOf(const Image<std::uint8_t>& rgb);
Image<std::uint8_t> greyOf(const Picture& picture);

}  // namespace ilf
