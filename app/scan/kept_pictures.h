// A scan's pictures as files, to be decoded again without the rig.
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/registration/gray_code.h"

namespace ilf::app {

/// 00.png, 01.png, ... in the order of `scan.patterns`, which is the order of `grayCodePatterns` and the one that
/// decode-scan takes where no manifest says another. The folder is made.
Result<void> keepPictures(const std::filesystem::path& folder, const Scan& scan);

}  // namespace ilf::app
