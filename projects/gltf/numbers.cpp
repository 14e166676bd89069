#include <algorithm>
#include <cmath>
#include <cstring>

#include "projects/gltf/checks.h"
#include "projects/gltf/model.h"

namespace ilf::projects::gltf {

namespace {

template <class T>
T loaded(const unsigned char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

double component(const unsigned char* at, int kind, bool normalized) {
    switch (kind) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        const double value = loaded<std::int8_t>(at);
        return normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return loaded<std::uint8_t>(at) / (normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        const double value = loaded<std::int16_t>(at);
        return normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return loaded<std::uint16_t>(at) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return loaded<std::uint32_t>(at);
    default:
        return static_cast<double>(loaded<float>(at));
    }
}

std::uint32_t index(const unsigned char* at, int kind) {
    return kind == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? loaded<std::uint8_t>(at)
           : kind == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? loaded<std::uint16_t>(at)
                                                            : loaded<std::uint32_t>(at);
}

/// How an accessor's elements lie: where each component begins within one (columns of small matrices are padded).
struct Lie {
    std::size_t element, stride;
    std::vector<std::size_t> offsets;
};

Lie lieOf(const tinygltf::Accessor& accessor, std::size_t viewStride) {
    const std::size_t bytes = bytesOfComponent(accessor.componentType);
    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    const std::size_t rows = accessor.type == TINYGLTF_TYPE_MAT2   ? 2
                             : accessor.type == TINYGLTF_TYPE_MAT3 ? 3
                                                                   : components;
    const bool padded = rows != components;
    const std::size_t column = padded ? (rows * bytes + 3) / 4 * 4 : rows * bytes;
    Lie lie{components / rows * column, 0, {}};
    for (std::size_t i = 0; i < components; ++i)
        lie.offsets.push_back(i / rows * column + i % rows * bytes);
    lie.stride = viewStride > 0 ? viewStride : lie.element;
    return lie;
}

std::string nameOf(int accessor) { return "accessors[" + std::to_string(accessor) + "]"; }

bool available(const tinygltf::Model& model, int view, int accessor, Findings& findings) {
    if (bytesOf(model, view)) return true;
    findings.refuse(nameOf(accessor), "lies in buffers[" +
                                          std::to_string(model.bufferViews[static_cast<std::size_t>(view)].buffer) +
                                          "], whose bytes the file does not name");
    return false;
}

/// Calls `set(element, component, address)` for the plain elements, then for the sparse ones.
template <class Set>
bool eachComponent(const tinygltf::Model& model, int which, Findings& findings, Set set) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(which)];
    if (accessor.bufferView >= 0) {
        if (!available(model, accessor.bufferView, which, findings)) return false;
        const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        const Lie lie = lieOf(accessor, view.byteStride);
        const unsigned char* at = bytesOf(model, accessor.bufferView)->data() + accessor.byteOffset;
        for (std::size_t i = 0; i < accessor.count; ++i, at += lie.stride) {
            for (std::size_t c = 0; c < lie.offsets.size(); ++c)
                set(i, c, at + lie.offsets[c]);
        }
    }
    if (!accessor.sparse.isSparse) return true;
    const auto& sparse = accessor.sparse;
    if (!available(model, sparse.indices.bufferView, which, findings) ||
        !available(model, sparse.values.bufferView, which, findings))
        return false;
    const Lie lie = lieOf(accessor, 0);
    const std::size_t step = bytesOfComponent(sparse.indices.componentType);
    const unsigned char* places = bytesOf(model, sparse.indices.bufferView)->data() + sparse.indices.byteOffset;
    const unsigned char* values = bytesOf(model, sparse.values.bufferView)->data() + sparse.values.byteOffset;
    for (int i = 0; i < sparse.count; ++i, places += step, values += lie.element) {
        const std::uint32_t place = index(places, sparse.indices.componentType);
        if (place >= accessor.count) {
            findings.refuse(nameOf(which) + ".sparse",
                            "changes element " + std::to_string(place) + " of " + std::to_string(accessor.count));
            return false;
        }
        for (std::size_t c = 0; c < lie.offsets.size(); ++c)
            set(place, c, values + lie.offsets[c]);
    }
    return true;
}

}  // namespace

std::optional<std::vector<float>> numbersOf(const tinygltf::Model& model, int which, Findings& findings,
                                            const std::vector<float>* base) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(which)];
    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    if (accessor.count > kMaxVertices) {
        findings.refuse(nameOf(which), "has " + std::to_string(accessor.count) + " elements, where up to " +
                                           std::to_string(kMaxVertices) + " are read");
        return std::nullopt;
    }
    std::vector<float> numbers = base != nullptr ? *base : std::vector<float>(accessor.count * components);
    bool finite = true;
    const bool good = eachComponent(model, which, findings, [&](std::size_t i, std::size_t c, const unsigned char* at) {
        const double value = component(at, accessor.componentType, accessor.normalized);
        if (finite && !std::isfinite(value)) {
            findings.refuse(nameOf(which), "holds no number at element " + std::to_string(i));
            finite = false;
        }
        numbers[i * components + c] = static_cast<float>(value);
    });
    if (!good || !finite) return std::nullopt;
    return numbers;
}

std::optional<std::vector<std::uint32_t>> indicesOf(const tinygltf::Model& model, int which, Findings& findings) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(which)];
    if (accessor.count > 3 * kMaxTriangles) {
        findings.refuse(nameOf(which),
                        "has " + std::to_string(accessor.count) + " indices, which is more than is read");
        return std::nullopt;
    }
    std::vector<std::uint32_t> indices(accessor.count);
    const bool good = eachComponent(model, which, findings, [&](std::size_t i, std::size_t, const unsigned char* at) {
        indices[i] = index(at, accessor.componentType);
    });
    if (!good) return std::nullopt;
    return indices;
}

void checkContents(const tinygltf::Model& model, Findings& findings) {
    for (std::size_t i = 0; i < model.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = model.accessors[i];
        const bool stored = accessor.bufferView >= 0 || accessor.sparse.isSparse;
        if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || !stored) continue;
        if (accessor.bufferView >= 0 && !bytesOf(model, accessor.bufferView)) continue;  // said where it is used
        numbersOf(model, static_cast<int>(i), findings);
    }
    for (std::size_t i = 0; i < model.skins.size() && findings.sound(); ++i) {
        const int which = model.skins[i].inverseBindMatrices;
        if (which < 0) continue;
        const auto matrices = numbersOf(model, which, findings);
        for (std::size_t at = 0; matrices && at + 16 <= matrices->size(); at += 16) {
            const float* m = matrices->data() + at;
            const float off = std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1.0F);
            if (off > 1e-4F) {
                findings.refuse("skins[" + std::to_string(i) + "].inverseBindMatrices",
                                "are not affine (their fourth row is not 0 0 0 1)");
                break;
            }
        }
    }
}

}  // namespace ilf::projects::gltf
