#include <nlohmann/json.hpp>
#include <vector>

#include "projects/gltf/checks.h"

namespace ilf::projects::gltf {

namespace {

using enum Checked::Need;
using nlohmann::json;

void checkNode(const Checked& node) {
    node.references("children", "nodes");
    node.reference("mesh", "meshes");
    node.reference("camera", "cameras");
    node.reference("skin", "skins");
    node.numbers("matrix", 16);
    node.numbers("translation", 3);
    node.numbers("rotation", 4);
    node.numbers("scale", 3);
    node.numbers("weights", 0);
    if (node.has("matrix") && (node.has("translation") || node.has("rotation") || node.has("scale")))
        node.refuse("matrix", "and translation, rotation or scale exclude each other");
}

/// Each node has one parent at most, and nobody is its own ancestor. Gives the parents; -1: a root.
std::vector<std::int64_t> checkForest(const Checked& gltf) {
    std::vector<std::int64_t> parent(countOf(gltf.json(), "nodes"), -1);
    gltf.each("nodes", optional, [&](const Checked& node, std::size_t i) {
        if (!node.has("children") || !node.json()["children"].is_array()) return;
        for (const json& child : node.json()["children"]) {
            const auto index = wholeOf(child);
            if (!index || *index < 0 || static_cast<std::size_t>(*index) >= parent.size()) continue;  // said already
            auto& its = parent[static_cast<std::size_t>(*index)];
            if (its >= 0)
                node.refuse("children", "name nodes[" + std::to_string(*index) + "], a child of nodes[" +
                                            std::to_string(its) + "] already");
            its = static_cast<std::int64_t>(i);
        }
    });
    // Upwards from each node, marking what is known to end at a root.
    std::vector<int> state(parent.size(), 0);  // 0 new, 1 on this way, 2 good
    for (std::size_t i = 0; i < parent.size(); ++i) {
        std::vector<std::size_t> way;
        std::int64_t at = static_cast<std::int64_t>(i);
        while (at >= 0 && state[static_cast<std::size_t>(at)] == 0) {
            state[static_cast<std::size_t>(at)] = 1;
            way.push_back(static_cast<std::size_t>(at));
            at = parent[static_cast<std::size_t>(at)];
        }
        if (at >= 0 && state[static_cast<std::size_t>(at)] == 1)
            gltf.refuse("nodes[" + std::to_string(at) + "]", "is its own ancestor: the nodes form a loop");
        for (const std::size_t node : way)
            state[node] = 2;
    }
    return parent;
}

void checkAnimation(const Checked& animation, const json& root) {
    const auto strided = [&](const Checked& sampler, const char* member) {
        const auto index = sampler.reference(member, "accessors", required);
        if (!index) return;
        const json& accessor = root["accessors"][*index];
        if (!accessor.contains("bufferView")) return;
        const auto view = wholeOf(accessor["bufferView"]);
        if (view && *view >= 0 && static_cast<std::size_t>(*view) < countOf(root, "bufferViews") &&
            root["bufferViews"][static_cast<std::size_t>(*view)].contains("byteStride"))
            sampler.refuse(member, "lies in a buffer view with a byteStride, which is for vertices only");
    };
    animation.each("samplers", required, [&](const Checked& sampler, std::size_t) {
        strided(sampler, "input");
        strided(sampler, "output");
    });
    const std::size_t samplers = countOf(animation.json(), "samplers");
    animation.each("channels", required, [&](const Checked& channel, std::size_t) {
        if (samplers > 0) channel.whole("sampler", 0, static_cast<std::int64_t>(samplers) - 1, required);
        if (const auto target = channel.object("target", required)) {
            target->text("path", required);
            target->reference("node", "nodes");
        }
    });
}

}  // namespace

void checkNodes(const Checked& gltf) {
    gltf.each("nodes", optional, [](const Checked& node, std::size_t) { checkNode(node); });
    const auto parent = checkForest(gltf);
    gltf.each("scenes", optional, [&](const Checked& scene, std::size_t) {
        scene.references("nodes", "nodes");
        if (!scene.has("nodes") || !scene.json()["nodes"].is_array()) return;
        for (const json& root : scene.json()["nodes"]) {
            const auto index = wholeOf(root);
            if (index && *index >= 0 && static_cast<std::size_t>(*index) < parent.size() &&
                parent[static_cast<std::size_t>(*index)] >= 0)
                scene.refuse("nodes", "name nodes[" + std::to_string(*index) +
                                          "], which is no root but a child of nodes[" +
                                          std::to_string(parent[static_cast<std::size_t>(*index)]) + "]");
        }
    });
    gltf.reference("scene", "scenes");
    gltf.each("skins", optional, [&](const Checked& skin, std::size_t) {
        skin.references("joints", "nodes", required);
        skin.reference("skeleton", "nodes");
        const auto matrices = skin.reference("inverseBindMatrices", "accessors");
        if (!matrices) return;
        const json& accessor = gltf.json()["accessors"][*matrices];
        const auto kind = accessor.find("componentType"), type = accessor.find("type"), count = accessor.find("count");
        if (kind == accessor.end() || type == accessor.end() || wholeOf(*kind) != 5126 || *type != "MAT4")
            skin.refuse("inverseBindMatrices", "must be 4x4 matrices of floats");
        else if (count != accessor.end() &&
                 wholeOf(*count).value_or(0) < static_cast<std::int64_t>(countOf(skin.json(), "joints")))
            skin.refuse("inverseBindMatrices", "are fewer than its joints");
    });
    gltf.each("animations", optional, [&](const Checked& one, std::size_t) { checkAnimation(one, gltf.json()); });
}

}  // namespace ilf::projects::gltf
