// Compressed geometry in glTF files: meshopt's buffer views and Draco's meshes.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "projects/gltf/findings.h"

namespace ilf::projects::gltf {

/// Puts what EXT_meshopt_compression packed into buffers of its own, filters undone, and lets the views point there.
void unpackMeshopt(tinygltf::Model& model, Findings& findings);

/// What KHR_draco_mesh_compression packed into one primitive.
struct Unpacked {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> triangles;                  ///< three indices each
    std::map<std::string, std::vector<float>> attributes;  ///< as many numbers a vertex as the accessor's type has
};

/// Nothing for a primitive that Draco did not pack, and where `findings` then says why it cannot be unpacked.
std::optional<Unpacked> unpackedDraco(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                      const std::string& where, Findings& findings);

}  // namespace ilf::projects::gltf
