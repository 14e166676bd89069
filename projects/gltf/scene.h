// The default scene of a checked glTF model: its nodes walked, its meshes moved to where they stand.
#pragma once

#include "projects/gltf/model.h"
#include "projects/gltf_file.h"

namespace ilf::projects::gltf {

/// Meshes and cameras of the default scene; materials, source and problems are the caller's. Nothing is of use where
/// `findings` then is not sound.
struct Shown {
    std::vector<Box<Mesh>> meshes;
    std::vector<GltfCamera> cameras;
};
Shown shownScene(const tinygltf::Model& model, Findings& findings);

/// One primitive as the file stores it, in its mesh's own frame.
struct Primitive {
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::array<float, 2>> texcoords;
    std::vector<std::array<std::uint8_t, 3>> colours;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    int material = -1;
};

/// Nothing where the primitive has no positions, or where `findings` then says what is wrong with it.
std::optional<Primitive> primitiveOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                     const std::string& where, Findings& findings);

}  // namespace ilf::projects::gltf
