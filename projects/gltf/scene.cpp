#include "projects/gltf/scene.h"

#include <cmath>
#include <glm/glm.hpp>
#include <map>

#include "core/solid/pose.h"

namespace ilf::projects::gltf {

namespace {

glm::dmat4 matrixOf(const tinygltf::Node& node, int index, Findings& findings) {
    glm::dmat4 m(1.0);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i)
            m[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
            findings.refuse("nodes[" + std::to_string(index) + "].matrix",
                            "is not affine (its last row is not 0 0 0 1)");
        return m;
    }
    if (node.rotation.size() == 4) {
        double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
        const double length = std::sqrt(x * x + y * y + z * z + w * w);
        if (!(length > 1e-6)) {
            findings.refuse("nodes[" + std::to_string(index) + "].rotation", "is no rotation: its length is 0");
            return m;
        }
        if (std::abs(length - 1.0) > 0.00674)  // glTF-Validator's own tolerance
            findings.remark("nodes[" + std::to_string(index) + "].rotation was no unit quaternion and was made one.");
        x /= length, y /= length, z /= length, w /= length;
        m[0] = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w), 0.0};
        m[1] = {2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w), 0.0};
        m[2] = {2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y), 0.0};
    }
    for (int i = 0; i < 3; ++i) {
        if (node.scale.size() == 3) m[i] *= node.scale[static_cast<std::size_t>(i)];
        if (node.translation.size() == 3) m[3][i] = node.translation[static_cast<std::size_t>(i)];
    }
    return m;
}

/// A primitive moved into the scene. A node that mirrors turns triangles over, so their order is turned back.
Mesh placed(const Primitive& primitive, const glm::dmat4& at, const std::string& name, const std::string& where,
            Findings& findings) {
    Mesh mesh;
    mesh.name = name;
    mesh.texcoords = primitive.texcoords;
    mesh.colours = primitive.colours;
    mesh.triangles = primitive.triangles;
    mesh.material = primitive.material;
    mesh.positions.reserve(primitive.positions.size());
    for (const auto& p : primitive.positions) {
        const glm::dvec4 moved = at * glm::dvec4(p[0], p[1], p[2], 1.0);
        mesh.positions.push_back(
            {static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z)});
        for (const float value : mesh.positions.back()) {
            if (std::isfinite(value)) continue;
            findings.refuse(where, "lies beyond every number once its nodes have moved it");
            return mesh;
        }
    }
    const glm::dmat3 linear(at);
    const double determinant = glm::determinant(linear);
    if (determinant < 0.0) {
        for (auto& triangle : mesh.triangles)
            std::swap(triangle[1], triangle[2]);
    }
    if (determinant == 0.0) return mesh;  // flattened: no direction stays at right angles
    const glm::dmat3 turn = glm::transpose(glm::inverse(linear));
    mesh.normals.reserve(primitive.normals.size());
    for (const auto& n : primitive.normals) {
        const glm::dvec3 turned = turn * glm::dvec3(n[0], n[1], n[2]);
        const double length = glm::length(turned);
        const glm::dvec3 unit = length > 0.0 && std::isfinite(length) ? turned / length : glm::dvec3(0.0);
        mesh.normals.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
    }
    return mesh;
}

class Walk {
public:
    Walk(const tinygltf::Model& model, Findings& findings) : model_(model), findings_(findings) {}

    Shown from(const std::vector<int>& roots) {
        struct Step {
            int node;
            glm::dmat4 parent;
        };
        std::vector<Step> open;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            open.push_back({*root, glm::dmat4(1.0)});
        while (!open.empty() && findings_.sound()) {
            const Step step = open.back();
            open.pop_back();
            const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(step.node)];
            const glm::dmat4 at = step.parent * matrixOf(node, step.node, findings_);
            if (node.mesh >= 0) showMesh(node, at);
            if (node.camera >= 0) showCamera(node, step.node, at);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, at});
        }
        return std::move(shown_);
    }

private:
    void showMesh(const tinygltf::Node& node, const glm::dmat4& at) {
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        if (node.skin >= 0) findings_.remark("Skins are not applied: meshes stand as they were modelled.");
        for (std::size_t i = 0; i < mesh.primitives.size() && findings_.sound(); ++i) {
            const std::string where = "meshes[" + std::to_string(node.mesh) + "].primitives[" + std::to_string(i) + "]";
            const auto key = std::pair(node.mesh, i);
            auto known = read_.find(key);
            if (known == read_.end())
                known = read_.emplace(key, primitiveOf(model_, mesh.primitives[i], where, findings_)).first;
            if (!known->second) continue;
            if (!mesh.primitives[i].targets.empty())
                findings_.remark("Morph targets are not applied: meshes stand as they were modelled.");
            vertices_ += known->second->positions.size();
            triangles_ += known->second->triangles.size();
            if (vertices_ > kMaxVertices || triangles_ > kMaxTriangles) {
                findings_.refuse("", "its scene has more than " + std::to_string(kMaxVertices / 1'000'000) +
                                         " million vertices or triangles, which is more than is read");
                return;
            }
            shown_.meshes.emplace_back(
                placed(*known->second, at, mesh.name.empty() ? node.name : mesh.name, where, findings_));
        }
    }

    void showCamera(const tinygltf::Node& node, int index, const glm::dmat4& at) {
        const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(node.camera)];
        std::array<double, 16> matrix{};
        for (int i = 0; i < 16; ++i)
            matrix[static_cast<std::size_t>(i)] = at[i / 4][i % 4];
        const auto pose = cameraFromGltfNode(matrix);
        if (!pose) {
            findings_.remark("The camera of nodes[" + std::to_string(index) +
                             "] is flattened by its nodes and left out.");
            return;
        }
        GltfCamera camera;
        camera.name = from.name.empty() ? node.name : from.name;
        camera.orthographic = from.type == "orthographic";
        camera.cameraFromModel = *pose;
        if (!camera.orthographic) {
            camera.yfov = from.perspective.yfov;
            if (from.perspective.aspectRatio > 0.0) camera.aspectRatio = from.perspective.aspectRatio;
        }
        shown_.cameras.push_back(std::move(camera));
    }

    const tinygltf::Model& model_;
    Findings& findings_;
    Shown shown_;
    std::map<std::pair<int, std::size_t>, std::optional<Primitive>> read_;
    std::size_t vertices_ = 0, triangles_ = 0;
};

}  // namespace

Shown shownScene(const tinygltf::Model& model, Findings& findings) {
    if (model.scenes.empty()) {
        findings.remark("The file has no scene, so that nothing of it is shown.");
        return {};
    }
    if (model.defaultScene < 0) findings.remark("The file names no scene to start with; the first one was taken.");
    if (model.scenes.size() > 1) findings.remark("The file's other scenes are not shown.");
    const auto index = static_cast<std::size_t>(std::max(0, model.defaultScene));
    return Walk(model, findings).from(model.scenes[index].nodes);
}

}  // namespace ilf::projects::gltf
