// Three-component vectors of the sample renderer: plain floats, because a door into the core never sees them.
#pragma once

#include <algorithm>
#include <cmath>

namespace ilf::samples {

constexpr float kPi = 3.14159265f;

struct V2 {
    float x = 0.0f, y = 0.0f;
};

struct V3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};

constexpr V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr V3 operator-(V3 a) { return {-a.x, -a.y, -a.z}; }
constexpr V3 operator*(V3 a, V3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr V3 operator*(V3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr V3 operator*(float s, V3 a) { return a * s; }
constexpr V3 operator/(V3 a, float s) { return a * (1.0f / s); }
constexpr float dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(V3 a) { return std::sqrt(dot(a, a)); }
inline float length(V2 a) { return std::sqrt(a.x * a.x + a.y * a.y); }
inline V3 normalized(V3 a) { return a / std::max(length(a), 1e-12f); }
inline V3 absolute(V3 a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
constexpr V3 mix(V3 a, V3 b, float t) { return a + (b - a) * t; }
constexpr float mix(float a, float b, float t) { return a + (b - a) * t; }
constexpr float clamp01(float x) { return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x; }
constexpr float luminance(V3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// 0 below `a`, 1 above `b`, smooth between; `a` > `b` gives the falling step.
constexpr float smoothstep(float a, float b, float x) {
    const float t = clamp01((x - a) / (b - a));
    return t * t * (3.0f - 2.0f * t);
}

/// A place and three right-handed unit axes in the world: objects are modelled in it, in metres.
struct Frame {
    V3 origin{};
    V3 x{1.0f, 0.0f, 0.0f}, y{0.0f, 1.0f, 0.0f}, z{0.0f, 0.0f, 1.0f};

    V3 local(V3 world) const {
        const V3 d = world - origin;
        return {dot(d, x), dot(d, y), dot(d, z)};
    }
    V3 world(V3 p) const { return origin + x * p.x + y * p.y + z * p.z; }
};

/// At `origin`, turned by `yaw` about the upward axis, then tipped by `pitch` about its own x (radians).
inline Frame placed(V3 origin, float yaw = 0.0f, float pitch = 0.0f) {
    const float c = std::cos(yaw), s = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    const V3 x{c, 0.0f, -s}, z0{s, 0.0f, c}, y0{0.0f, 1.0f, 0.0f};
    return {origin, x, y0 * cp + z0 * sp, z0 * cp - y0 * sp};
}

/// `frame` turned by `roll` (radians) about its own z axis.
inline Frame rolled(const Frame& frame, float roll) {
    const float c = std::cos(roll), s = std::sin(roll);
    return {frame.origin, frame.x * c + frame.y * s, frame.y * c - frame.x * s, frame.z};
}

}  // namespace ilf::samples
