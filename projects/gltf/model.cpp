#include "projects/gltf/model.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "projects/gltf/checker.h"
#include "projects/gltf/compressed.h"

namespace ilf::projects::gltf {

namespace {

using nlohmann::json;

/// What tinygltf need not see: buffers and images (their bytes are ours to read), extras and animations. Whole numbers
/// lose their decimal point, which tinygltf takes for a fraction.
json reduced(const json& value) {
    if (value.is_object()) {
        json less = json::object();
        for (const auto& [key, member] : value.items()) {
            if (key != "extras") less[key] = reduced(member);
        }
        return less;
    }
    if (value.is_array()) {
        json less = json::array();
        for (const json& member : value)
            less.push_back(reduced(member));
        return less;
    }
    if (value.is_number_float()) {
        if (const auto whole = wholeOf(value)) return *whole;
    }
    return value;
}

/// Indices that Draco packed lie in no buffer view, which tinygltf refuses; the packed ones are read instead.
void withoutPackedIndices(json& root) {
    if (!root.contains("meshes")) return;
    for (json& mesh : root["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
        }
    }
}

/// The bytes of one buffer; empty where the file names none (which matters only if something lies in it).
std::string bytesOfBuffer(const json& buffer, std::size_t i, const Container& container, const Beside& beside,
                          Findings& findings) {
    const std::string where = "buffers[" + std::to_string(i) + "]";
    const auto length = static_cast<std::size_t>(wholeOf(buffer["byteLength"]).value_or(0));
    std::string bytes;
    if (buffer.contains("uri")) {
        auto read = beside.buffer(buffer["uri"].get<std::string>());
        if (!read) {
            findings.refuse(where + ".uri", read.error());
            return {};
        }
        bytes = std::move(*read);
    } else if (i == 0 && container.bin) {
        bytes = *container.bin;
        if (bytes.size() > length + 3) findings.remark("The binary chunk is longer than the buffer it holds.");
    } else {
        const bool fallback = buffer.contains("extensions");
        // A GLB's first buffer without a name is its binary chunk.
        if (i == 0 && !fallback && container.glb)
            findings.refuse(where, "should be the binary chunk, which is missing");
        return {};
    }
    if (bytes.size() < length) {
        findings.refuse(where,
                        "has " + std::to_string(bytes.size()) + " bytes, where it promises " + std::to_string(length));
        return {};
    }
    bytes.resize(length);
    return bytes;
}

}  // namespace

std::optional<tinygltf::Model> modelOf(const json& root, const Container& container, const Beside& beside,
                                       Findings& findings) {
    std::vector<std::string> buffers;
    std::size_t total = 0;
    if (root.contains("buffers")) {
        for (std::size_t i = 0; i < root["buffers"].size() && findings.sound(); ++i) {
            buffers.push_back(bytesOfBuffer(root["buffers"][i], i, container, beside, findings));
            total += buffers.back().size();
            if (total > kMaxBytes) findings.refuse("buffers", "hold more than 1 GiB, which is more than is read");
        }
    }
    if (!findings.sound()) return std::nullopt;

    json without = root;
    for (const char* list : {"buffers", "images", "animations"})
        without.erase(list);
    withoutPackedIndices(without);
    const std::string text = reduced(without).dump();
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error, warning;
    bool parsed = false;
    try {
        parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                            static_cast<unsigned int>(text.size()), "");
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!parsed) {
        while (!error.empty() && (error.back() == '\n' || error.back() == '.'))
            error.pop_back();
        findings.refuse("", "tinygltf says of it: " + error);
        return std::nullopt;
    }
    for (const std::string& bytes : buffers)
        model.buffers.emplace_back().data.assign(bytes.begin(), bytes.end());
    unpackMeshopt(model, findings);
    if (!findings.sound()) return std::nullopt;
    return model;
}

std::optional<std::basic_string_view<unsigned char>> bytesOf(const tinygltf::Model& model, int view) {
    const tinygltf::BufferView& it = model.bufferViews[static_cast<std::size_t>(view)];
    const auto& data = model.buffers[static_cast<std::size_t>(it.buffer)].data;
    if (data.size() < it.byteOffset + it.byteLength) return std::nullopt;
    return std::basic_string_view<unsigned char>(data.data() + it.byteOffset, it.byteLength);
}

}  // namespace ilf::projects::gltf
