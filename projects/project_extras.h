// What is inside ProjectExtras, for opening and saving only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "projects/json.h"
#include "projects/project_depth.h"
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
    Json project, wearer, rig;     ///< as they were read or last written
    std::filesystem::path origin;  ///< the project they belong to; empty: none yet
    std::vector<Original> originals;
    std::vector<EncodedMask> masks;
    EncodedDepth depth, measured;
    struct EncodedMap {
        Box<DenseMap> map;
        Box<std::string> bytes;
    };
    EncodedMap map;  ///< of the rig's registration
};

}  // namespace ilf::projects
