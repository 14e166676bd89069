#include "core/solid/draw.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/srgb.h"
#include "core/solid/raster.h"
#include "core/solid/texture.h"

namespace ilf {

namespace {

constexpr float kAmbient = 0.2F;

bool bends(const Pinhole& camera) { return camera.distortion != std::array<double, 5>{}; }

/// Slopes of a pixel's ray; nothing where distortion cannot be undone there.
std::optional<glm::dvec2> slopesAt(const Pinhole& camera, double x, double y) {
    const auto [u, v] = camera.slopesOf(x, y);
    const auto [backX, backY] = camera.pixelOf(u, v);
    if (!(std::hypot(backX - x, backY - y) < 1e-3)) return std::nullopt;
    return glm::dvec2(u, v);
}

/// A camera without distortion, of the same scale, that sees all that `camera` sees (up to four times its size).
Pinhole straightened(const Pinhole& camera) {
    if (!bends(camera)) return camera;
    glm::dvec2 least(1e9), most(-1e9);
    const int w = camera.size.width, h = camera.size.height;
    const auto include = [&](double x, double y) {
        if (const auto at = slopesAt(camera, x, y)) {
            least = glm::min(least, *at);
            most = glm::max(most, *at);
        }
    };
    for (int i = 0; i <= w; ++i)
        include(i, 0.0), include(i, h);
    for (int i = 0; i <= h; ++i)
        include(0.0, i), include(w, i);
    include(camera.cx, camera.cy);
    if (!(most.x > least.x) || !(most.y > least.y)) return camera;
    Pinhole straight{camera.size, camera.fx, camera.fy, 0.0, 0.0, {}};
    const auto side = [](double least_px, double most_px, int usual, int& pixels, double& centre) {
        pixels = static_cast<int>(std::clamp(std::ceil(most_px - least_px) + 2.0, 1.0,
                                             static_cast<double>(std::min(4 * usual, kLargestDrawn))));
        centre = 1.0 - least_px;
    };
    side(camera.fx * least.x, camera.fx * most.x, w, straight.size.width, straight.cx);
    side(camera.fy * least.y, camera.fy * most.y, h, straight.size.height, straight.cy);
    return straight;
}

/// A triangle's place and plane, kept while neighbouring pixels see the same one.
struct Facing {
    std::uint32_t triangle = kNoTriangle;
    std::size_t mesh = 0;
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 across, along, normal;  ///< two edges, and their product
    double plane = 0.0;                ///< normal . corner

    void turnTo(std::uint32_t which, const SeenTriangles& triangles) {
        if (which == triangle) return;
        triangle = which;
        mesh = triangles.meshOf(which);
        corners = triangles.corners(which, mesh);
        across = corners[1] - corners[0];
        along = corners[2] - corners[0];
        normal = glm::cross(across, along);
        plane = glm::dot(normal, corners[0]);
    }
    /// Depth where a ray meets the plane, within the corners' depths.
    double depth(const glm::dvec3& ray) const {
        const auto [nearest, farthest] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
        return std::clamp(plane / glm::dot(normal, ray), std::max(nearest, kNearestDrawn_m),
                          std::max(farthest, kNearestDrawn_m));
    }
    /// How much of each corner a point of the plane is, within the triangle.
    glm::vec3 shares(const glm::dvec3& point) const {
        const glm::dvec3 from = point - corners[0];
        const double whole = glm::dot(normal, normal);
        const double second = std::clamp(glm::dot(glm::cross(from, along), normal) / whole, 0.0, 1.0);
        const double third = std::clamp(glm::dot(glm::cross(across, from), normal) / whole, 0.0, 1.0 - second);
        return {static_cast<float>(1.0 - second - third), static_cast<float>(second), static_cast<float>(third)};
    }
};

class Shader {
public:
    Shader(const SeenTriangles& triangles, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& pose)
        : triangles_(triangles), focal_(0.5 * (camera.fx + camera.fy)) {
        const auto& r = pose.rotation;
        turn_ = glm::dmat3(r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]);
        const auto& materials = triangles.solid->materials;
        textures_.resize(materials.size());
        parallelFor(static_cast<int>(materials.size()), [&](int i) {
            const auto which = static_cast<std::size_t>(i);
            if (!materials[which]->texture.empty()) textures_[which].emplace(*materials[which]);
        });
    }

    void shade(const Facing& facing, const glm::dvec3& ray, double depth, std::uint8_t* rgb) const {
        const Mesh& mesh = *triangles_.solid->meshes[facing.mesh];
        const auto& indices = mesh.triangles[facing.triangle - triangles_.firstTriangle[facing.mesh]];
        const glm::vec3 share = facing.shares(depth * ray);
        const auto mixed = [&](const auto& values, auto number) {
            auto sum = number(values[indices[0]]) * share[0];
            for (int i = 1; i < 3; ++i)
                sum += number(values[indices[static_cast<std::size_t>(i)]]) * share[i];
            return sum;
        };
        glm::dvec3 normal = facing.normal;
        if (!mesh.normals.empty()) {
            const glm::dvec3 smooth =
                turn_ * glm::dvec3(mixed(mesh.normals, [](const auto& n) { return glm::vec3(n[0], n[1], n[2]); }));
            if (glm::dot(smooth, smooth) > 1e-6) normal = smooth;
        }
        const double towards = std::abs(glm::dot(normal, ray)) / (glm::length(normal) * glm::length(ray));
        glm::vec3 light(kAmbient + (1.0F - kAmbient) * static_cast<float>(towards));
        if (mesh.material >= 0) {
            const auto which = static_cast<std::size_t>(mesh.material);
            const Material& material = *triangles_.solid->materials[which];
            light *= glm::vec3(material.colour[0], material.colour[1], material.colour[2]);
            if (textures_[which] && !mesh.texcoords.empty())
                light *= textured(facing, mesh, indices, share, ray, depth);
        } else {
            const Material plain;
            light *= glm::vec3(plain.colour[0], plain.colour[1], plain.colour[2]);
        }
        if (!mesh.colours.empty())
            light *= mixed(mesh.colours, [](const auto& c) { return glm::vec3(c[0], c[1], c[2]) / 255.0F; });
        for (int i = 0; i < 3; ++i)
            rgb[i] = srgb8(light[i]);
    }

private:
    glm::vec3 textured(const Facing& facing, const Mesh& mesh, const std::array<std::uint32_t, 3>& indices,
                       const glm::vec3& share, const glm::dvec3& ray, double depth) const {
        const Texture& texture = *textures_[static_cast<std::size_t>(mesh.material)];
        const auto uv = [&](std::size_t i) {
            return glm::vec2(mesh.texcoords[indices[i]][0], mesh.texcoords[indices[i]][1]);
        };
        const glm::vec2 a = uv(0), b = uv(1), c = uv(2);
        const glm::vec2 at = a * share[0] + b * share[1] + c * share[2];
        // Texels in a square metre of the triangle, and the square root of a pixel's area on it.
        const glm::vec2 p = b - a, q = c - a;
        const double texels = std::abs(static_cast<double>(p.x) * q.y - static_cast<double>(p.y) * q.x) *
                              texture.size().width * texture.size().height;
        const double area = glm::length(facing.normal);
        const double slant = std::abs(glm::dot(facing.normal, ray)) / (area * glm::length(ray));
        const double pixel = depth / focal_;
        const auto side = static_cast<float>(std::sqrt(texels / area / std::max(slant, 0.05)) * pixel);
        const auto value = texture.at(at.x, at.y, std::isfinite(side) ? side : 1.0F);
        return {value[0], value[1], value[2]};
    }

    const SeenTriangles& triangles_;
    double focal_;
    glm::dmat3 turn_;
    std::vector<std::optional<Texture>> textures_;
};

DrawnSolid draw(const Solid& solid, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& pose, bool coloured) {
    const SeenTriangles triangles = seenTriangles(solid, pose);
    const Pinhole straight = straightened(camera);
    const Visible seen = visible(triangles, straight);
    const bool bent = bends(camera);
    const auto width = static_cast<std::size_t>(camera.size.width);
    const std::size_t pixels = width * static_cast<std::size_t>(camera.size.height);
    std::vector<float> depth(pixels, 0.0F);
    std::vector<std::uint8_t> colour(coloured ? 3 * pixels : 0, 0);
    std::optional<Shader> shader;
    if (coloured) shader.emplace(triangles, camera, pose);
    parallelFor(camera.size.height, [&](int y) {
        Facing facing;
        for (int x = 0; x < camera.size.width; ++x) {
            const std::size_t to = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            std::size_t from = to;
            glm::dvec3 ray((x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy, 1.0);
            if (bent) {
                const auto slopes = slopesAt(camera, x + 0.5, y + 0.5);
                if (!slopes) continue;
                ray = glm::dvec3(*slopes, 1.0);
                const double u = std::floor(straight.fx * ray.x + straight.cx);
                const double v = std::floor(straight.fy * ray.y + straight.cy);
                if (!(u >= 0.0) || !(v >= 0.0) || !(u < straight.size.width) || !(v < straight.size.height)) continue;
                from = static_cast<std::size_t>(v) * static_cast<std::size_t>(straight.size.width) +
                       static_cast<std::size_t>(u);
            }
            if (seen.triangle[from] == kNoTriangle) continue;
            double z = 1.0 / static_cast<double>(seen.nearness[from]);
            if (bent || coloured) facing.turnTo(seen.triangle[from], triangles);
            if (bent) z = facing.depth(ray);
            depth[to] = static_cast<float>(z);
            if (coloured) shader->shade(facing, ray, z, colour.data() + 3 * to);
        }
    });
    DrawnSolid result;
    result.depth = Image<float>(camera.size, 1, std::move(depth));
    if (coloured) result.colour = Image<std::uint8_t>(camera.size, 3, std::move(colour));
    return result;
}

}  // namespace

DrawnSolid drawn(const Solid& solid, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& cameraFromModel) {
    return draw(solid, camera, cameraFromModel, true);
}

Image<float> drawnDepth(const Solid& solid, const Pinhole& camera,
                        const Pose<CameraSpace, ModelSpace>& cameraFromModel) {
    return draw(solid, camera, cameraFromModel, false).depth;
}

}  // namespace ilf
