// Rays against every triangle, one by one: what drawings are judged by.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/registration/pinhole.h"
#include "core/solid/mesh.h"

namespace ilf {

/// How near an edge a ray passes, beside how far it goes.
struct Cast {
    double depth = 0.0;   ///< metres along the camera's axis; 0: nothing there
    double margin = 1e9;  ///< pixels from the nearest outline of any triangle the ray comes near
};

/// The ray through (x, y), pixels, of an undistorted camera. Möller and Trumbore's test, in double.
inline Cast cast(const Solid& solid, const Pinhole& camera, const Pose<CameraSpace, ModelSpace>& pose, double x,
                 double y) {
    const std::array<double, 3> ray{(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0};
    const auto cross = [](const auto& a, const auto& b) {
        return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    Cast found;
    for (const Box<Mesh>& mesh : solid.meshes) {
        for (const auto& triangle : mesh->triangles) {
            std::array<std::array<double, 3>, 3> p{};
            bool before = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto& at = mesh->positions[triangle[i]];
                const auto moved = pose({at[0], at[1], at[2]});
                p[i] = {moved.x, moved.y, moved.z};
                before = before && moved.z > 1e-4;
            }
            if (before) {
                for (std::size_t i = 0; i < 3; ++i) {  // distance to the edge in the picture
                    const auto &a = p[i], &b = p[(i + 1) % 3];
                    const double ax = camera.fx * a[0] / a[2] + camera.cx, ay = camera.fy * a[1] / a[2] + camera.cy;
                    const double dx = camera.fx * b[0] / b[2] + camera.cx - ax,
                                 dy = camera.fy * b[1] / b[2] + camera.cy - ay;
                    const double length = dx * dx + dy * dy;
                    const double t =
                        length > 0.0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / length, 0.0, 1.0) : 0.0;
                    found.margin = std::min(found.margin, std::hypot(x - ax - t * dx, y - ay - t * dy));
                }
            }
            const std::array<double, 3> e{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
            const std::array<double, 3> f{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
            const auto h = cross(ray, f);
            const double whole = dot(e, h);
            if (whole == 0.0) continue;
            const std::array<double, 3> s{-p[0][0], -p[0][1], -p[0][2]};
            const double u = dot(s, h) / whole;
            const auto q = cross(s, e);
            const double v = dot(ray, q) / whole, t = dot(f, q) / whole;
            if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > 1e-4)) continue;
            if (found.depth == 0.0 || t < found.depth) found.depth = t;
        }
    }
    return found;
}

}  // namespace ilf
