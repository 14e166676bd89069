// What a glTF file's JSON must hold before anything in it is followed: the parts of the check, by kind of object.
#pragma once

#include "projects/gltf/checker.h"

namespace ilf::projects::gltf {

/// Everything below. `gltf` is the file's root object.
void checkAll(const Checked& gltf, Findings& findings);

/// asset, lists of objects, extensions: declared, required, known.
void checkRoot(const Checked& gltf, Findings& findings);
/// buffers, bufferViews and accessors, by what they claim: every byte an accessor reaches lies in its view, every view
/// in its buffer.
void checkData(const Checked& gltf);
/// meshes: modes, attributes of equal count and of kinds that can be read.
void checkMeshes(const Checked& gltf);
/// nodes, scenes, skins and animations: a forest whose roots are shown.
void checkNodes(const Checked& gltf);
/// materials, textures, samplers, images and cameras.
void checkLooks(const Checked& gltf);

/// Bytes of one component (0: no such code) and components of a type (0: no such type).
std::size_t bytesOfComponent(std::int64_t code);
std::size_t componentsOf(const std::string& type);

}  // namespace ilf::projects::gltf
