// How depth lies in a project: as the PNG of whole steps it came as where that is exact, else as EXR.
#pragma once

#include <string>
#include <string_view>

#include "core/base/box.h"
#include "core/base/result.h"
#include "core/document/distance.h"

namespace ilf::projects {

struct EncodedDepth {
    DepthMap depth;
    Box<std::string> bytes;
    std::string extension;  ///< ".png" or ".exr"
};

/// `known` itself where it is of the same pixels.
Result<EncodedDepth> encodedDepth(const DepthMap& depth, const EncodedDepth& known);

/// `step`: of a file of whole numbers.
Result<DepthMap> decodedDepth(std::string_view bytes, const std::string& name, Metre step);

}  // namespace ilf::projects
