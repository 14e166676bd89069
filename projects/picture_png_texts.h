// What PNG files say of themselves besides their pixels.
#pragma once

#include <string>

#include "projects/picture_export.h"

namespace ilf::projects {

/// The same file with a text for each fact (tEXt, or iTXt beyond ASCII), and the mark that its codes are sRGB. `png`
/// must be a sound PNG.
std::string withFacts(const std::string& png, const PictureFacts& facts, bool srgb);

}  // namespace ilf::projects
