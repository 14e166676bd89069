// The two kinds of map file; what is read is whole and of the right kind, but not yet checked for sense.
#pragma once

#include <string>
#include <string_view>

#include "projects/map_file.h"

namespace ilf::projects {

Result<std::string> mapAsYaml(const DenseMap& map, const MapFacts& facts);
Result<MapFile> mapFromYaml(const std::string& text, const std::string& name);

Result<std::string> mapAsExr(const DenseMap& map, const MapFacts& facts);
Result<MapFile> mapFromExr(std::string_view bytes, const std::string& name);

}  // namespace ilf::projects
