#include <cmath>
#include <nlohmann/json.hpp>

#include "projects/gltf/checks.h"
#include "projects/gltf/container.h"
#include "projects/gltf/looks.h"
#include "projects/gltf/model.h"
#include "projects/gltf/scene.h"
#include "projects/gltf_file.h"
#include "projects/safe_file.h"

namespace ilf::projects {

namespace {

using namespace gltf;
using nlohmann::json;

/// Why a JSON text cannot be read, short: nlohmann's sentence without its own name for it.
std::string spokenReason(const json::exception& e) {
    const std::string text = e.what();
    const auto end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2, 160);
}

std::optional<GltfScene> sceneOf(std::string_view bytes, const fs::path& path, const GltfReading& reading,
                                 Findings& findings) {
    const auto container = opened(bytes, findings);
    if (!container) return std::nullopt;
    json root;
    try {
        root = json::parse(container->json.begin(), container->json.end());
    } catch (const json::exception& e) {
        findings.refuse("", "its JSON is damaged: " + spokenReason(e));
        return std::nullopt;
    }
    if (!root.is_object()) {
        findings.refuse("", "its JSON is no object");
        return std::nullopt;
    }
    checkAll(Checked(root, "", root, findings), findings);
    if (!findings.sound()) return std::nullopt;
    const Beside beside(path);
    const auto model = modelOf(root, *container, beside, findings);
    if (!model) return std::nullopt;
    checkContents(*model, findings);
    if (!findings.sound()) return std::nullopt;
    Shown shown = shownScene(*model, findings);
    if (!findings.sound()) return std::nullopt;
    if (root.contains("animations")) findings.remark("Animations are not played: the scene is at rest.");
    auto materials = materialsOf(root, *model, beside, reading.textures, findings);
    Solid solid{spoken(path.filename()), std::move(shown.meshes), std::move(materials)};
    return GltfScene{Box<Solid>(std::move(solid)), std::move(shown.cameras), model->asset.generator, {}};
}

}  // namespace

Pinhole GltfCamera::pinhole(Size size) const { return plainPinhole(size, 0.5 * size.height / std::tan(0.5 * yfov)); }

Result<GltfScene> readGltf(const fs::path& path, const GltfReading& reading) {
    const auto bytes = readWhole(path, kMaxBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    Findings findings;
    try {
        auto scene = sceneOf(*bytes, path, reading, findings);
        if (!scene) return findings.error(spoken(path), "Export it again, or see what glTF-Validator says of it.");
        scene->problems = findings.takeRemarks();
        return std::move(*scene);
    } catch (const std::bad_alloc&) {
        return fail(Fault::badFile, spoken(path) + " needs more memory than there is: export it with fewer triangles.");
    }
}

}  // namespace ilf::projects
