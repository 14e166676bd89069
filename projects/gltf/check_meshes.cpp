#include <nlohmann/json.hpp>

#include "projects/gltf/checks.h"

namespace ilf::projects::gltf {

namespace {

using enum Checked::Need;
using nlohmann::json;

std::int64_t numberAt(const json& object, const char* member) {
    const auto found = object.find(member);
    return found == object.end() ? 0 : wholeOf(*found).value_or(0);
}

bool typeIs(const json& accessor, const char* type) {
    const auto found = accessor.find("type");
    return found != accessor.end() && *found == type;
}

/// All attributes are accessors of as many elements as the first; what is read is of a kind that can be.
void checkAttributes(const Checked& attributes, const json& accessors, std::optional<std::int64_t>& count) {
    for (const auto& [name, ignored] : attributes.json().items()) {
        const auto index = attributes.reference(name.c_str(), "accessors");
        if (!index) continue;
        const json& accessor = accessors[*index];
        const std::int64_t here = numberAt(accessor, "count"), kind = numberAt(accessor, "componentType");
        if (!count) count = here;
        if (here != *count)
            attributes.refuse(name, "has " + std::to_string(here) + " elements, others " + std::to_string(*count));
        if ((name == "POSITION" || name == "NORMAL") && (!typeIs(accessor, "VEC3") || kind == 5125))
            attributes.refuse(name, "must be of three numbers a vertex");
        if (name.starts_with("TEXCOORD_") && (!typeIs(accessor, "VEC2") || kind == 5125))
            attributes.refuse(name, "must be of two numbers a vertex");
        if (name.starts_with("COLOR_") && !typeIs(accessor, "VEC3") && !typeIs(accessor, "VEC4"))
            attributes.refuse(name, "must be of three or four numbers a vertex");
    }
}

void checkPrimitive(const Checked& primitive, const json& accessors) {
    std::optional<std::int64_t> count;
    const auto attributes = primitive.object("attributes", required);
    if (attributes && attributes->json().empty()) primitive.refuse("attributes", "is empty");
    if (attributes) checkAttributes(*attributes, accessors, count);
    if (const auto indices = primitive.reference("indices", "accessors")) {
        const json& accessor = accessors[*indices];
        const std::int64_t kind = numberAt(accessor, "componentType");
        if (!typeIs(accessor, "SCALAR") || (kind != 5121 && kind != 5123 && kind != 5125))
            primitive.refuse("indices", "must be whole numbers without sign");
    }
    primitive.oneOf("mode", {0, 1, 2, 3, 4, 5, 6});
    primitive.reference("material", "materials");
    primitive.each("targets", optional, [&](const Checked& target, std::size_t) {
        if (target.json().empty()) target.refuse("is empty");
        auto same = count;
        checkAttributes(target, accessors, same);
    });
    if (!primitive.has("extensions")) return;
    const auto extensions = primitive.object("extensions");
    const auto draco = extensions ? extensions->object("KHR_draco_mesh_compression") : std::nullopt;
    if (!draco) return;
    draco->reference("bufferView", "bufferViews", required);
    const auto mode = primitive.has("mode") ? numberAt(primitive.json(), "mode") : 4;
    if (mode != 4 && mode != 5) primitive.refuse("mode", "of Draco's meshes must be triangles or a strip");
    if (const auto named = draco->object("attributes", required)) {
        for (const auto& [name, ignored] : named->json().items()) {
            named->whole(name.c_str(), 0, 0xFFFFFFFFLL);
            if (attributes && !attributes->has(name.c_str())) named->refuse(name, "is no attribute of the primitive");
        }
    }
}

}  // namespace

void checkMeshes(const Checked& gltf) {
    static const json kNone = json::array();
    const json& root = gltf.json();
    const json& accessors = root.contains("accessors") ? root["accessors"] : kNone;
    gltf.each("meshes", optional, [&](const Checked& mesh, std::size_t) {
        mesh.each("primitives", required,
                  [&](const Checked& primitive, std::size_t) { checkPrimitive(primitive, accessors); });
        mesh.numbers("weights", 0);
    });
}

}  // namespace ilf::projects::gltf
