#include "projects/gltf/container.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace ilf::projects::gltf {

namespace {

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

std::optional<Container> glb(std::string_view bytes, Findings& findings) {
    const auto refused = [&](const std::string& what) {
        findings.refuse("", what);
        return std::nullopt;
    };
    if (bytes.size() < kHeader) return refused("it ends within the GLB header");
    if (word(bytes, 4) != 2)
        return refused("it is version " + std::to_string(word(bytes, 4)) + " of GLB, where 2 is read");
    const std::size_t length = word(bytes, 8);
    if (length < kHeader + kChunkHeader) return refused("its GLB header says a length without room for a chunk");
    if (length > bytes.size())
        return refused("it ends early: its GLB header promises " + std::to_string(length) + " bytes, there are " +
                       std::to_string(bytes.size()));
    if (length < bytes.size()) {
        findings.remark("The file goes on after the end of its GLB stream; what follows was ignored.");
        bytes = bytes.substr(0, length);
    }
    Container found;
    found.glb = true;
    int chunk = 0;
    for (std::size_t at = kHeader; at < bytes.size(); ++chunk) {
        const std::string name = "GLB chunk " + std::to_string(chunk);
        if (bytes.size() - at < kChunkHeader) return refused(name + " ends within its header");
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += kChunkHeader;
        if (size > bytes.size() - at) return refused(name + " is longer than the file");
        if (size % 4 != 0) return refused(name + " has a length that is no multiple of 4");
        const std::string_view content = bytes.substr(at, size);
        at += size;
        if (chunk == 0 && type != kJson) return refused("its first GLB chunk is not JSON");
        if (type == kJson) {
            if (chunk != 0) return refused("it has two JSON chunks");
            if (content.empty()) return refused("its JSON chunk is empty");
            found.json = content;
        } else if (type == kBin) {
            if (found.bin) return refused("it has two binary chunks");
            if (chunk != 1) return refused("its binary chunk is not the second one");
            found.bin = content;
        } else {
            findings.remark(name + " is of a kind nobody knows and was ignored.");
        }
    }
    if (chunk == 0) return refused("it has no GLB chunk");
    return found;
}

}  // namespace

std::size_t nesting(std::string_view json) {
    std::size_t depth = 0, deepest = 0;
    bool inString = false, escaped = false;
    for (const char c : json) {
        if (inString) {
            if (escaped) {
                escaped = false;
            } else if (c == '\\') {
                escaped = true;
            } else if (c == '"') {
                inString = false;
            }
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

std::optional<Container> opened(std::string_view bytes, Findings& findings) {
    std::optional<Container> found;
    if (bytes.starts_with("glTF")) {
        found = glb(bytes, findings);
    } else {
        const auto first = bytes.find_first_not_of(" \t\r\n");
        if (first == std::string_view::npos) {
            findings.refuse("", "it is empty");
        } else if (bytes[first] != '{' && !bytes.starts_with("\xEF\xBB\xBF")) {
            findings.refuse("", "it begins neither with a JSON object nor with \"glTF\"");
        } else {
            found = Container{bytes, std::nullopt, false};
        }
    }
    if (!found) return found;
    if (found->json.starts_with("\xEF\xBB\xBF")) {
        findings.refuse("", "its JSON begins with a byte-order mark");
        return std::nullopt;
    }
    if (nesting(found->json) > kMaxDepth) {
        findings.refuse("", "its JSON is nested more than " + std::to_string(kMaxDepth) + " deep");
        return std::nullopt;
    }
    return found;
}

}  // namespace ilf::projects::gltf
