// TIFF files of 16-bit codes.
#pragma once

#include <string>

#include "projects/picture_export.h"

namespace ilf::projects {

/// 1 (grey) or 3 (RGB) channels of 16 bits, compressed without loss. Facts become the description, "key: value; ...".
/// Codes in sRGB carry its ICC profile.
Result<std::string> encodeTiff16(const Picture& codes, const PictureFacts& facts, bool srgb);

}  // namespace ilf::projects
