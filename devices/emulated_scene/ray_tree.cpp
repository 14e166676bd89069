#include "devices/emulated_scene/ray_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ilf::devices::scene {
namespace {

constexpr std::uint32_t kLeaf = 4;
/// A shadow's ray must not meet the face it starts from.
constexpr double kNear = 1e-7;

double part(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
Vec3 middle(const Triangle& t) { return (1.0 / 3.0) * (t.corner[0] + t.corner[1] + t.corner[2]); }

}  // namespace

RayTree::RayTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    nodes_.reserve(2 * triangles_.size() + 2);
    nodes_.emplace_back();
    if (triangles_.empty()) return;
    split(0, 0, static_cast<std::uint32_t>(triangles_.size()));
    faces_.reserve(triangles_.size());
    for (const Triangle& t : triangles_)
        faces_.push_back({t.corner[0], t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]});
}

void RayTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30}, least = low, most = high;
    const auto widen = [](Vec3& a, Vec3& b, const Vec3& p) {
        a = {std::min(a.x, p.x), std::min(a.y, p.y), std::min(a.z, p.z)};
        b = {std::max(b.x, p.x), std::max(b.y, p.y), std::max(b.z, p.z)};
    };
    for (std::uint32_t i = begin; i < end; ++i) {
        for (const Vec3& corner : triangles_[i].corner)
            widen(low, high, corner);
        widen(least, most, middle(triangles_[i]));
    }
    for (int axis = 0; axis < 3; ++axis) {  // a little wider, for what floats lose
        nodes_[node].low[axis] = static_cast<float>(part(low, axis)) - 1e-5F;
        nodes_[node].high[axis] = static_cast<float>(part(high, axis)) + 1e-5F;
    }
    const Vec3 spread = most - least;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    if (end - begin <= kLeaf || part(spread, axis) <= 0.0) {
        nodes_[node].first = begin;
        nodes_[node].count = end - begin;
        return;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    const auto at = [&](std::uint32_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [axis](const Triangle& a, const Triangle& b) {
        return part(middle(a), axis) < part(middle(b), axis);
    });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_.emplace_back();
    nodes_[node].first = left;
    split(left, begin, half);
    split(left + 1, half, end);
}

template <class Visit>
void RayTree::walk(const Vec3& from, const Vec3& along, double until, Visit&& visit) const {
    if (triangles_.empty()) return;
    const double inverse[3] = {1.0 / along.x, 1.0 / along.y, 1.0 / along.z};
    const double start[3] = {from.x, from.y, from.z};
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        double in = 0.0, out = until;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (static_cast<double>(node.low[axis]) - start[axis]) * inverse[axis];
            const double b = (static_cast<double>(node.high[axis]) - start[axis]) * inverse[axis];
            in = std::max(in, std::min(a, b));
            out = std::min(out, std::max(a, b));
        }
        if (!(in <= out)) continue;
        if (node.count == 0) {
            stack[depth++] = node.first + 1;
            stack[depth++] = node.first;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            // Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997; both sides count.
            const Face& face = faces_[i];
            const Vec3 p = cross(along, face.edge2);
            const double volume = dot(face.edge1, p);
            if (volume == 0.0) continue;
            const Vec3 s = from - face.corner;
            const double b = dot(s, p) / volume;
            if (b < 0.0 || b > 1.0) continue;
            const Vec3 q = cross(s, face.edge1);
            const double c = dot(along, q) / volume;
            if (c < 0.0 || b + c > 1.0) continue;
            const double t = dot(face.edge2, q) / volume;
            if (t > kNear && t < until && visit(Met{t, i, b, c}, until)) return;
        }
    }
}

std::optional<Met> RayTree::first(const Vec3& from, const Vec3& along) const {
    std::optional<Met> nearest;
    walk(from, along, std::numeric_limits<double>::infinity(), [&](const Met& met, double& until) {
        nearest = met;
        until = met.distance;
        return false;
    });
    return nearest;
}

bool RayTree::blocked(const Vec3& from, const Vec3& along, double until) const {
    bool any = false;
    walk(from, along, until, [&](const Met&, double&) { return any = true; });
    return any;
}

}  // namespace ilf::devices::scene
