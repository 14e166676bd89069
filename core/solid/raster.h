// Which triangle each pixel of an undistorted camera sees.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "core/registration/pinhole.h"
#include "core/solid/mesh.h"

namespace ilf {

/// All triangles of a solid in the camera's space, counted through its meshes.
struct SeenTriangles {
    std::vector<glm::dvec3> vertices;        ///< of all meshes
    std::vector<std::size_t> firstVertex;    ///< of each mesh
    std::vector<std::size_t> firstTriangle;  ///< of each mesh, and one past the last
    const Solid* solid = nullptr;

    std::size_t count() const { return firstTriangle.back(); }
    std::size_t meshOf(std::size_t triangle) const;
    /// The corners; `mesh` is meshOf(triangle).
    std::array<glm::dvec3, 3> corners(std::size_t triangle, std::size_t mesh) const;
};
SeenTriangles seenTriangles(const Solid& solid, const Pose<CameraSpace, ModelSpace>& cameraFromModel);

inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// Row-major.
struct Visible {
    Size size;
    std::vector<float> nearness;          ///< 1 / depth; 0: nothing there
    std::vector<std::uint32_t> triangle;  ///< or kNoTriangle
};
/// `camera` as if it had no distortion.
Visible visible(const SeenTriangles& triangles, const Pinhole& camera);

}  // namespace ilf
