// Points, directions and rigid motions of the emulated scene's world; its own, so that no mistake is shared.
#pragma once

#include <array>
#include <cmath>

namespace ilf::devices::scene {

/// Metres, or no unit for directions. World: x to the right along the desk, y away from whoever sits at it, z up.
struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
    bool operator==(const Vec3&) const = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double k, const Vec3& a) { return {k * a.x, k * a.y, k * a.z}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return (1.0 / length(a)) * a; }

/// Where a thing stands: its axes as the world sees them, and its origin.
struct Placed {
    Vec3 right{1, 0, 0}, down{0, 1, 0}, ahead{0, 0, 1};
    Vec3 at;

    Vec3 toWorld(const Vec3& p) const { return at + turnedToWorld(p); }
    Vec3 turnedToWorld(const Vec3& d) const { return d.x * right + d.y * down + d.z * ahead; }
    Vec3 fromWorld(const Vec3& w) const {
        const Vec3 d = w - at;
        return {dot(d, right), dot(d, down), dot(d, ahead)};
    }
};

/// A device at `at` whose axis goes through `target`, upright, then rolled clockwise as it sees.
Placed lookingAt(const Vec3& at, const Vec3& target, double roll_deg = 0.0);
/// `placed` moved by `by_m` along its own axes and turned about its own down axis, then its own right axis.
Placed nudged(const Placed& placed, const Vec3& by_m, double yaw_deg, double pitch_deg);

}  // namespace ilf::devices::scene
