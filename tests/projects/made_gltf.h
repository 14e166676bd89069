// A small sound glTF scene for tests to spoil: a square of two triangles in a folder of its own.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "projects/gltf_file.h"
#include "tests/projects/folder.h"

namespace ilf {

/// Four vertices at z = 0, x and y 0 or 1, two triangles counter-clockwise as seen from +z; one node shows them.
struct MadeSquare {
    std::vector<float> positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<std::uint16_t> indices{0, 1, 2, 0, 2, 3};
    static constexpr const char* kJson = R"({
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "data.bin", "byteLength": 60}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0})";
    Folder folder;

    std::string bytes() const {
        std::string all(4 * positions.size() + 2 * indices.size(), '\0');
        std::memcpy(all.data(), positions.data(), 4 * positions.size());
        std::memcpy(all.data() + 4 * positions.size(), indices.data(), 2 * indices.size());
        return all;
    }
    /// `json`: kJson, or what a test made of it.
    Result<projects::GltfScene> readAs(const std::string& json) const {
        folder.put("data.bin", bytes());
        return projects::readGltf(folder.put("scene.gltf", json));
    }
};

}  // namespace ilf
