#include <algorithm>
#include <cmath>

#include "projects/gltf/compressed.h"
#include "projects/gltf/looks.h"
#include "projects/gltf/scene.h"

namespace ilf::projects::gltf {

namespace {

/// Reads attributes of one primitive, whether packed or plain.
class Attributes {
public:
    Attributes(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const Unpacked* unpacked,
               Findings& findings)
        : model_(model), primitive_(primitive), unpacked_(unpacked), findings_(findings) {}

    std::optional<std::vector<float>> operator()(const std::string& name) const {
        const auto found = primitive_.attributes.find(name);
        if (found == primitive_.attributes.end()) return std::nullopt;
        const std::vector<float>* base = nullptr;
        if (unpacked_ != nullptr) {
            const auto packed = unpacked_->attributes.find(name);
            if (packed != unpacked_->attributes.end()) base = &packed->second;
        }
        return numbersOf(model_, found->second, findings_, base);
    }
    /// Numbers a vertex.
    int width(const std::string& name) const {
        const auto found = primitive_.attributes.find(name);
        if (found == primitive_.attributes.end()) return 0;
        return tinygltf::GetNumComponentsInType(
            static_cast<std::uint32_t>(model_.accessors[static_cast<std::size_t>(found->second)].type));
    }

private:
    const tinygltf::Model& model_;
    const tinygltf::Primitive& primitive_;
    const Unpacked* unpacked_;
    Findings& findings_;
};

template <std::size_t N>
std::vector<std::array<float, N>> grouped(const std::vector<float>& numbers) {
    std::vector<std::array<float, N>> groups(numbers.size() / N);
    for (std::size_t i = 0; i < groups.size(); ++i)
        std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(N * i), N, groups[i].begin());
    return groups;
}

std::vector<std::array<std::uint8_t, 3>> coloursOf(const std::vector<float>& numbers, std::size_t width) {
    std::vector<std::array<std::uint8_t, 3>> colours(numbers.size() / width);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            colours[i][c] =
                static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(numbers[width * i + c], 0.0F, 1.0F)));
    }
    return colours;
}

/// Triangles of a list, strip or fan, all wound alike. Two vertices left over at a list's end are dropped.
std::vector<std::array<std::uint32_t, 3>> trianglesOf(int mode, const std::vector<std::uint32_t>& indices) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const std::size_t count = indices.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(count / 3);
        for (std::size_t i = 0; i + 2 < count; i += 3)
            triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t i = 0; i + 2 < count; ++i)
            triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (std::size_t i = 1; i + 1 < count; ++i)
            triangles.push_back({indices[i], indices[i + 1], indices[0]});
    }
    return triangles;
}

/// Whether what the file says of an accessor's extent is so, to what a float holds of it.
bool claimsHold(const tinygltf::Accessor& accessor, const std::vector<std::array<float, 3>>& positions) {
    if (accessor.normalized || accessor.minValues.size() != 3 || accessor.maxValues.size() != 3 || positions.empty())
        return true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax_element(positions.begin(), positions.end(),
                                                       [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        const double low = static_cast<double>((*least)[axis]), high = static_cast<double>((*most)[axis]);
        const double tolerance = 1e-5 * std::max({1e-30, std::abs(low), std::abs(high)});
        if (std::abs(low - accessor.minValues[axis]) > tolerance ||
            std::abs(high - accessor.maxValues[axis]) > tolerance)
            return false;
    }
    return true;
}

}  // namespace

std::optional<Primitive> primitiveOf(const tinygltf::Model& model, const tinygltf::Primitive& from,
                                     const std::string& where, Findings& findings) {
    const auto position = from.attributes.find("POSITION");
    if (position == from.attributes.end()) {
        findings.remark(where + " has no positions and is not drawn.");
        return std::nullopt;
    }
    const auto unpacked = unpackedDraco(model, from, where, findings);
    if (!findings.sound()) return std::nullopt;
    const std::size_t vertices = model.accessors[static_cast<std::size_t>(position->second)].count;
    if (unpacked && unpacked->vertices != vertices) {
        findings.refuse(where, "unpacks to " + std::to_string(unpacked->vertices) +
                                   " vertices, where its accessors say " + std::to_string(vertices));
        return std::nullopt;
    }
    const Attributes attributes(model, from, unpacked ? &*unpacked : nullptr, findings);
    Primitive primitive;
    primitive.material = from.material;
    if (const auto numbers = attributes("POSITION")) primitive.positions = grouped<3>(*numbers);
    if (const auto numbers = attributes("NORMAL")) primitive.normals = grouped<3>(*numbers);
    if (const auto numbers = attributes("COLOR_0"))
        primitive.colours = coloursOf(*numbers, static_cast<std::size_t>(attributes.width("COLOR_0")));
    const TextureLie lie =
        from.material >= 0 ? textureLie(model.materials[static_cast<std::size_t>(from.material)]) : TextureLie{};
    if (const auto numbers = attributes("TEXCOORD_" + std::to_string(lie.set))) {
        primitive.texcoords = grouped<2>(*numbers);
        for (auto& [u, v] : primitive.texcoords) {
            const auto laid = lie(u, v);
            u = laid[0];
            v = laid[1];
        }
    }
    if (!findings.sound()) return std::nullopt;
    // Draco rounds: its vertices are near what was claimed of them, not at it.
    if (!unpacked && !claimsHold(model.accessors[static_cast<std::size_t>(position->second)], primitive.positions))
        findings.remark(where + " claims an extent that its vertices do not have; theirs counts.");

    const int mode = from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode;
    std::vector<std::uint32_t> indices;
    if (unpacked) {
        indices = unpacked->triangles;
    } else if (from.indices >= 0) {
        auto read = indicesOf(model, from.indices, findings);
        if (!read) return std::nullopt;
        indices = std::move(*read);
    } else {
        indices.resize(vertices);
        for (std::size_t i = 0; i < vertices; ++i)
            indices[i] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < vertices) continue;
        findings.refuse(where + ".indices", "use vertex " + std::to_string(indices[i]) + " of " +
                                                std::to_string(vertices) + " (index " + std::to_string(i) + ")");
        return std::nullopt;
    }
    // Draco gives separate triangles, whatever was packed.
    primitive.triangles = trianglesOf(unpacked ? TINYGLTF_MODE_TRIANGLES : mode, indices);
    if (mode < TINYGLTF_MODE_TRIANGLES) findings.remark("Points and lines are not drawn.");
    if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
        findings.remark(where + " ends with an unfinished triangle, which is not drawn.");
    return primitive;
}

}  // namespace ilf::projects::gltf
