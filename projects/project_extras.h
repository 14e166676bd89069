// What is inside ProjectExtras, for opening and saving only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "projects/json.h"
#include "projects/project_file.h"

namespace ilf::projects {

struct ProjectExtras::State {
    struct Original {
        Picture picture;
        Box<std::string> bytes;
        std::string extension;
    };
    struct EncodedMask {
        RegionId region;
        Mask mask;
        Box<std::string> bytes;
    };
    struct EncodedDepth {
        Image<std::uint16_t> raw;
        Box<std::string> bytes;
    };

    Json project, wearer, rig;     ///< as they were read or last written
    std::filesystem::path origin;  ///< the project they belong to; empty: none yet
    std::vector<Original> originals;
    std::vector<EncodedMask> masks;
    EncodedDepth depth;
};

}  // namespace ilf::projects
