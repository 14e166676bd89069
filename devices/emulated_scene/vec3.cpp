#include "devices/emulated_scene/vec3.h"

#include <numbers>

namespace ilf::devices::scene {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// `v` turned about the unit vector `axis` (Rodrigues).
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

Placed turnedAbout(Placed p, const Vec3& axis, double angle) {
    p.right = turned(p.right, axis, angle);
    p.down = turned(p.down, axis, angle);
    p.ahead = turned(p.ahead, axis, angle);
    return p;
}

}  // namespace

Placed lookingAt(const Vec3& at, const Vec3& target, double roll_deg) {
    Placed placed;
    placed.at = at;
    placed.ahead = unit(target - at);
    placed.right = unit(cross(placed.ahead, Vec3{0, 0, 1}));
    placed.down = cross(placed.ahead, placed.right);
    return turnedAbout(placed, placed.ahead, roll_deg * kRadians);
}

Placed nudged(const Placed& placed, const Vec3& by_m, double yaw_deg, double pitch_deg) {
    Placed moved = turnedAbout(placed, placed.down, yaw_deg * kRadians);
    moved = turnedAbout(moved, moved.right, pitch_deg * kRadians);
    moved.at = placed.at + placed.turnedToWorld(by_m);
    return moved;
}

}  // namespace ilf::devices::scene
