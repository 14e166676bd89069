// `decode-scan`: a folder of a camera's pictures of Gray-code patterns becomes a map, checked before success is said.
#pragma once

#include <string>

namespace ilf::app {

struct DecodeScanOptions {
    std::string folder;
    std::string out;        ///< .yml, .yaml, .yml.gz, .yaml.gz or .exr
    std::string projector;  ///< "1024x768"; empty: as the folder's scan.json says, or 1024x768
    std::string quality;    ///< PNG to write, or empty
    bool json = false;
};
int decodeScanCommand(const DecodeScanOptions& options);

}  // namespace ilf::app
