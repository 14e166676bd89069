// The formats behind depth_file.h, as they are in the file: holes not yet made 0.
#pragma once

#include <string>
#include <string_view>

#include "core/base/image.h"
#include "core/base/result.h"

namespace ilf::projects {

struct DepthPixels {
    Image<float> metres;
    Image<float> sigma;  ///< may be empty
};

bool looksLikePfm(std::string_view bytes);
Result<DepthPixels> decodePfm(std::string_view bytes, const std::string& name);

bool looksLikeExr(std::string_view bytes);
Result<DepthPixels> decodeDepthExr(std::string_view bytes, const std::string& name);

}  // namespace ilf::projects
