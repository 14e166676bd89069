#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "projects/gltf/checks.h"

namespace ilf::projects::gltf {

namespace {

using nlohmann::json;

/// Required extensions that are read, or whose absence changes neither shape nor base colour. Others are refused.
bool known(std::string_view extension) {
    static const std::set<std::string_view> names{"KHR_draco_mesh_compression",
                                                  "EXT_meshopt_compression",
                                                  "KHR_mesh_quantization",
                                                  "KHR_texture_transform",
                                                  "KHR_lights_punctual",
                                                  "KHR_animation_pointer",
                                                  "KHR_xmp",
                                                  "KHR_xmp_json_ld",
                                                  "EXT_mesh_gpu_instancing",
                                                  "KHR_texture_basisu",
                                                  "EXT_texture_webp",
                                                  "EXT_texture_avif",
                                                  "EXT_lights_image_based"};
    return extension.starts_with("KHR_materials_") || names.contains(extension);
}

std::set<std::string> names(const Checked& gltf, const char* member) {
    std::set<std::string> found;
    if (!gltf.has(member)) return found;
    const json& list = gltf.json()[member];
    if (!list.is_array() || list.empty()) {
        gltf.refuse(member, list.is_array() ? "is an empty list, which glTF does not allow" : "must be a list");
        return found;
    }
    for (const json& one : list) {
        if (!one.is_string()) {
            gltf.refuse(member, "must hold names");
        } else if (!found.insert(one.get<std::string>()).second) {
            gltf.refuse(member, "names " + one.get<std::string>() + " twice");
        }
    }
    return found;
}

/// Every "extensions" is an object of objects whose names extensionsUsed declares. What extras hold is nobody's.
void checkExtensions(const json& value, const std::string& where, const std::set<std::string>& used,
                     Findings& findings) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_structured())
                checkExtensions(value[i], where + "[" + std::to_string(i) + "]", used, findings);
        }
        return;
    }
    for (const auto& [key, member] : value.items()) {
        if (key == "extras") continue;
        const std::string name = where.empty() ? key : where + "." + key;
        if (key == "extensions") {
            if (!member.is_object()) {
                findings.refuse(name, "must be an object");
                continue;
            }
            for (const auto& [extension, content] : member.items()) {
                if (!content.is_object()) findings.refuse(name + "." + extension, "must be an object");
                if (!used.contains(extension))
                    findings.refuse(name + "." + extension, "is used, but extensionsUsed does not name it");
            }
        }
        if (member.is_structured()) checkExtensions(member, name, used, findings);
    }
}

}  // namespace

void checkRoot(const Checked& gltf, Findings& findings) {
    using enum Checked::Need;
    if (const auto asset = gltf.object("asset", required)) {
        const auto version = asset->text("version", required);
        if (version && !version->starts_with("2."))
            asset->refuse("version", "is " + version->substr(0, 20) + ", where 2.0 is read");
        const auto least = asset->text("minVersion");
        if (least && *least != "2.0") asset->refuse("minVersion", "is " + least->substr(0, 20) + ", where 2.0 is read");
        asset->text("generator");
    }
    const std::set<std::string> used = names(gltf, "extensionsUsed");
    for (const std::string& name : names(gltf, "extensionsRequired")) {
        if (!used.contains(name)) gltf.refuse("extensionsRequired", "names " + name + ", extensionsUsed does not");
        if (!known(name)) gltf.refuse("extensionsRequired", "names " + name + ", which this version cannot read");
    }
    checkExtensions(gltf.json(), "", used, findings);
    if (used.contains("EXT_mesh_gpu_instancing"))
        findings.remark("Instances (EXT_mesh_gpu_instancing) are not shown: each mesh stands once, where its node is.");
    for (const char* list : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                             "meshes", "nodes", "samplers", "scenes", "skins", "textures"})
        gltf.each(list, optional, [](const Checked& one, std::size_t) { one.text("name"); });
}

void checkAll(const Checked& gltf, Findings& findings) {
    checkRoot(gltf, findings);
    // What follows trusts that lists are lists of objects.
    if (!findings.sound()) return;
    checkData(gltf);
    checkMeshes(gltf);
    checkLooks(gltf);
    checkNodes(gltf);
}

}  // namespace ilf::projects::gltf
