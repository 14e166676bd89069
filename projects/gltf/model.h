// A checked glTF file as tinygltf's model, with all its bytes in memory.
#pragma once

#include <tiny_gltf.h>

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "projects/gltf/beside.h"
#include "projects/gltf/container.h"

namespace ilf::projects::gltf {

/// tinygltf parses the JSON; the bytes of buffers are put in here, since it would read files from anywhere and refuses
/// buffers that stand in for compressed ones. Images are left out of the model (see looks.h). Buffer views compressed
/// by meshopt are unpacked. Precondition: `root` passed `checkAll`.
std::optional<tinygltf::Model> modelOf(const nlohmann::json& root, const Container& container, const Beside& beside,
                                       Findings& findings);

/// The bytes of a buffer view; nothing where its buffer has none.
std::optional<std::basic_string_view<unsigned char>> bytesOf(const tinygltf::Model& model, int view);

/// The numbers of an accessor, `components` each, normalised ones as -1..1 or 0..1. `base` holds what sparse values are
/// laid over, where that is compressed elsewhere. Nothing where `findings` then says why: bytes missing, not numbers.
std::optional<std::vector<float>> numbersOf(const tinygltf::Model& model, int accessor, Findings& findings,
                                            const std::vector<float>* base = nullptr);
/// Of indices.
std::optional<std::vector<std::uint32_t>> indicesOf(const tinygltf::Model& model, int accessor, Findings& findings);

/// Every float the file holds is a number, and inverse bind matrices are affine.
void checkContents(const tinygltf::Model& model, Findings& findings);

}  // namespace ilf::projects::gltf
