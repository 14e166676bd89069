// OpenEXR files of linear values.
#pragma once

#include <string>

#include "projects/picture_export.h"

namespace ilf::projects {

/// Channels R, G and B with the chromaticities of sRGB (Rec. 709, D65), or Y for one channel; each fact is a string
/// attribute of its name. Lossless compression (ZIP).
Result<std::string> encodeExr(const Radiance& values, const PictureFacts& facts, ExrDepth depth);

}  // namespace ilf::projects
