// Signed distances of simple solids in metres, negative inside, with the smooth joins a sculptor needs.
// Source of the formulas: Inigo Quilez, "distance functions" and "smooth minimum" (iquilezles.org/articles).
#pragma once

#include "vec.h"

namespace ilf::samples {

inline float sphere(V3 p, float radius) { return length(p) - radius; }

/// Not exact: a good bound near the surface, which is where it is asked.
inline float ellipsoid(V3 p, V3 r) {
    const V3 a{p.x / r.x, p.y / r.y, p.z / r.z};
    const V3 b{a.x / r.x, a.y / r.y, a.z / r.z};
    const float k = length(a);
    return k < 1e-4f ? -std::min({r.x, r.y, r.z}) : k * (k - 1.0f) / length(b);
}

inline float box(V3 p, V3 half, float rounding = 0.0f) {
    const V3 q = absolute(p) - half + V3{rounding, rounding, rounding};
    const V3 o{std::max(q.x, 0.0f), std::max(q.y, 0.0f), std::max(q.z, 0.0f)};
    return length(o) + std::min(std::max({q.x, q.y, q.z}), 0.0f) - rounding;
}

/// Upright, centred on the origin.
inline float cylinder(V3 p, float radius, float halfHeight, float rounding = 0.0f) {
    const V2 d{length(V2{p.x, p.z}) - radius + rounding, std::fabs(p.y) - halfHeight + rounding};
    return std::min(std::max(d.x, d.y), 0.0f) + length(V2{std::max(d.x, 0.0f), std::max(d.y, 0.0f)}) - rounding;
}

inline float capsule(V3 p, V3 a, V3 b, float radius) {
    const V3 pa = p - a, ba = b - a;
    return length(pa - ba * clamp01(dot(pa, ba) / dot(ba, ba))) - radius;
}

/// A capsule whose radius goes from `ra` at `a` to `rb` at `b`.
inline float taper(V3 p, V3 a, V3 b, float ra, float rb) {
    const V3 pa = p - a, ba = b - a;
    const float h = clamp01(dot(pa, ba) / dot(ba, ba));
    return length(pa - ba * h) - mix(ra, rb, h);
}

/// A ring about the upward axis.
inline float torus(V3 p, float ring, float tube) { return length(V2{length(V2{p.x, p.z}) - ring, p.y}) - tube; }

/// Both, joined by a fillet about `k` wide.
inline float join(float a, float b, float k) {
    const float h = std::max(k - std::fabs(a - b), 0.0f) / k;
    return std::min(a, b) - h * h * k * 0.25f;
}

/// `a` without `tool`, the edge softened over about `k`.
inline float carve(float a, float tool, float k) { return -join(-a, tool, k); }

/// What both have in common, the edge softened over about `k`.
inline float common(float a, float b, float k) { return -join(-a, -b, k); }

/// A wall of `thickness` about the surface.
inline float shell(float d, float thickness) { return std::fabs(d) - 0.5f * thickness; }

inline V3 mirrorX(V3 p) { return {std::fabs(p.x), p.y, p.z}; }

inline V3 turnedX(V3 p, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}
inline V3 turnedY(V3 p, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}
inline V3 turnedZ(V3 p, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

}  // namespace ilf::samples
