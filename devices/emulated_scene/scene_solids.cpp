#include <algorithm>
#include <cmath>

#include "core/base/srgb.h"
#include "devices/emulated_scene/scene_things.h"

namespace ilf::devices::scene {
namespace {

Look lookOf(const Material& material) {
    Look look;
    look.colour = material.colour;
    if (!material.texture.empty() && material.texture.channels() == 3) {
        std::vector<float> linear(material.texture.pixels().size());
        std::ranges::transform(material.texture.pixels(), linear.begin(),
                               [](std::uint8_t code) { return static_cast<float>(linearFromSrgb(code / 255.0)); });
        look.texture = Image<float>(material.texture.size(), 3, std::move(linear));
    }
    return look;
}

Vec3 vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

Things thingsOf(const Solid& solid, const Placed& at, double scale) {
    Things things;
    for (const Box<Material>& material : solid.materials)
        things.addLook(lookOf(*material));
    const int grey = things.addLook({});
    for (const Box<Mesh>& mesh : solid.meshes) {
        const bool known = mesh->material >= 0 && std::cmp_less(mesh->material, solid.materials.size());
        for (const auto& index : mesh->triangles) {
            Triangle t;
            for (std::size_t i = 0; i < 3; ++i) {
                t.corner[i] = at.toWorld(scale * vec(mesh->positions[index[i]]));
                if (!mesh->texcoords.empty()) t.uv[i] = mesh->texcoords[index[i]];
            }
            const Vec3 across = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
            if (!(length(across) > 0.0)) continue;  // no area: nothing to see
            for (std::size_t i = 0; i < 3; ++i) {
                t.normal[i] = unit(across);
                if (mesh->normals.empty()) continue;
                const Vec3 n = at.turnedToWorld(vec(mesh->normals[index[i]]));
                if (length(n) > 0.0) t.normal[i] = unit(n);
            }
            t.surface = things.surfaces;
            t.look = known ? mesh->material : grey;
            things.triangles.push_back(t);
        }
        ++things.surfaces;
    }
    return things;
}

Things thingsOfDepth(const Image<float>& depth, const SceneLens& lens, const Placed& from, int grid, double jump) {
    Things things;
    const int look = things.addLook({});
    const auto at = [&](int x, int y) {
        const double z = static_cast<double>(depth.at(x, y));
        return from.toWorld(z * lens.rayThrough(x + 0.5, y + 0.5));
    };
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 across = cross(b - a, c - a);
        if (!(length(across) > 0.0)) return;
        const Vec3 n = unit(across);
        things.triangles.push_back({{a, b, c}, {n, n, n}, {}, 0, look});
    };
    for (int y = 0; y + grid < depth.height(); y += grid) {
        for (int x = 0; x + grid < depth.width(); x += grid) {
            const float z[4] = {depth.at(x, y), depth.at(x + grid, y), depth.at(x + grid, y + grid),
                                depth.at(x, y + grid)};
            const auto [least, most] = std::minmax_element(z, z + 4);
            const bool whole = std::all_of(z, z + 4, [](float v) { return std::isfinite(v) && v > 0.0F; });
            if (!whole || static_cast<double>(*most) > static_cast<double>(*least) * (1.0 + jump)) continue;
            const Vec3 p[4] = {at(x, y), at(x + grid, y), at(x + grid, y + grid), at(x, y + grid)};
            add(p[0], p[1], p[2]);
            add(p[0], p[2], p[3]);
        }
    }
    things.surfaces = 1;
    return things;
}

}  // namespace ilf::devices::scene
