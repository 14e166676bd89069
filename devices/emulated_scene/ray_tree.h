// Finds the first triangle along a ray: a tree of boxes.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "devices/emulated_scene/scene_things.h"

namespace ilf::devices::scene {

/// Where a ray met a triangle: `b`, `c` weigh its second and third corner.
struct Met {
    double distance = 0.0;  ///< in lengths of the ray's direction
    std::uint32_t triangle = 0;
    double b = 0.0, c = 0.0;
};

class RayTree {
public:
    explicit RayTree(std::vector<Triangle> triangles);

    std::optional<Met> first(const Vec3& from, const Vec3& along) const;
    /// Whether anything is met before `until` directions' lengths.
    bool blocked(const Vec3& from, const Vec3& along, double until) const;
    const Triangle& triangle(std::uint32_t index) const { return triangles_[index]; }

private:
    struct Node {
        float low[3], high[3];
        std::uint32_t first = 0;  ///< of a leaf: its first triangle; else the left child, the right one follows it
        std::uint32_t count = 0;  ///< of triangles; 0: no leaf
    };
    /// Corner and edges, ready for the test.
    struct Face {
        Vec3 corner, edge1, edge2;
    };
    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    template <class Visit>
    void walk(const Vec3& from, const Vec3& along, double until, Visit&& visit) const;

    std::vector<Triangle> triangles_;
    std::vector<Face> faces_;
    std::vector<Node> nodes_;
};

}  // namespace ilf::devices::scene
