// Materials of a glTF file with their base colour textures.
#pragma once

#include <tiny_gltf.h>

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/base/box.h"
#include "core/solid/mesh.h"
#include "projects/gltf/beside.h"
#include "projects/gltf/findings.h"

namespace ilf::projects::gltf {

/// One for each of the file's materials. A texture that cannot be read is left out, with a remark. `root` is the file's
/// JSON, which names the images; without `textures` none is read.
std::vector<Box<Material>> materialsOf(const nlohmann::json& root, const tinygltf::Model& model, const Beside& beside,
                                       bool textures, Findings& findings);

/// How a base colour texture lies on a mesh: which set of coordinates, and KHR_texture_transform.
struct TextureLie {
    int set = 0;
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0}, rotation = 0.0;

    /// Offset * rotation * scale, as the extension's specification composes them.
    std::array<float, 2> operator()(float u, float v) const;
};
TextureLie textureLie(const tinygltf::Material& material);

}  // namespace ilf::projects::gltf
