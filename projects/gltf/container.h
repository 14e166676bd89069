// The outermost layer of a glTF file: JSON text, or the chunks of a GLB.
#pragma once

#include <optional>
#include <string_view>

#include "projects/gltf/findings.h"

namespace ilf::projects::gltf {

struct Container {
    std::string_view json;                ///< into the file's bytes
    std::optional<std::string_view> bin;  ///< a GLB's binary chunk
    bool glb = false;
};

/// Nothing where `findings` then says why.
std::optional<Container> opened(std::string_view bytes, Findings& findings);

/// How deep brackets nest in a JSON text (strings skipped).
std::size_t nesting(std::string_view json);

}  // namespace ilf::projects::gltf
