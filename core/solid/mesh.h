// Triangles of a scene as values, as files give them and depth and pictures are drawn from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/base/image.h"

namespace ilf {

/// A surface's look: what of the light it gives back, without shine.
struct Material {
    enum class Wrap { repeat, mirror, clamp };      ///< what a texture shows outside 0..1
    std::array<float, 3> colour{0.8F, 0.8F, 0.8F};  ///< linear, 0..1; multiplies the texture
    Image<std::uint8_t> texture;                    ///< RGB, sRGB-encoded; may be empty
    std::array<Wrap, 2> wrap{};                     ///< to the right, downwards
    bool doubleSided = false;
    bool operator==(const Material&) const = default;
};

/// Triangles of one material, in the scene's frame (glTF: metres, y up, right-handed).
struct Mesh {
    std::string name;
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;         ///< empty, or one a position
    std::vector<std::array<float, 2>> texcoords;       ///< empty, or one a position: (0, 0) is the texture's upper left
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< empty, or one a position: multiply the material's, linear
    std::vector<std::array<std::uint32_t, 3>> triangles;
    int material = -1;  ///< index, or -1: plain grey
    bool operator==(const Mesh&) const = default;
};

struct Solid {
    std::string source;  ///< file name, for the operator
    std::vector<Box<Mesh>> meshes;
    std::vector<Box<Material>> materials;
    bool operator==(const Solid&) const = default;
};

}  // namespace ilf
