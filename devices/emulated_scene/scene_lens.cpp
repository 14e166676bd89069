#include "devices/emulated_scene/scene_lens.h"

namespace ilf::devices::scene {
namespace {

/// Slopes as they leave the lens, and how each changes with each slope that entered.
struct Bent {
    double u, v;
    double uu, uv, vu, vv;
};

Bent bent(const std::array<double, 5>& k, double a, double b) {
    const auto [k1, k2, p1, p2, k3] = k;
    const double q = a * a + b * b;
    const double stretch = 1.0 + k1 * q + k2 * q * q + k3 * q * q * q;
    const double perQ = k1 + 2.0 * k2 * q + 3.0 * k3 * q * q;
    Bent out{};
    out.u = a * stretch + 2.0 * p1 * a * b + p2 * (q + 2.0 * a * a);
    out.v = b * stretch + p1 * (q + 2.0 * b * b) + 2.0 * p2 * a * b;
    out.uu = stretch + 2.0 * a * a * perQ + 2.0 * p1 * b + 6.0 * p2 * a;
    out.uv = 2.0 * a * b * perQ + 2.0 * p1 * a + 2.0 * p2 * b;
    out.vu = out.uv;
    out.vv = stretch + 2.0 * b * b * perQ + 6.0 * p1 * b + 2.0 * p2 * a;
    return out;
}

}  // namespace

std::optional<std::array<double, 2>> SceneLens::rasterOf(const Vec3& p) const {
    if (p.z <= 1e-6) return std::nullopt;
    const Bent there = bent(bend, p.x / p.z, p.y / p.z);
    return std::array{centreX + focalX * there.u, centreY + focalY * there.v};
}

Vec3 SceneLens::rayThrough(double x, double y) const {
    const double u = (x - centreX) / focalX, v = (y - centreY) / focalY;
    double a = u, b = v;
    // Newton's method with the exact derivative: lenses bend by a few per cent, four rounds reach rounding.
    for (int round = 0; round < 12; ++round) {
        const Bent there = bent(bend, a, b);
        const double du = u - there.u, dv = v - there.v;
        const double area = there.uu * there.vv - there.uv * there.vu;
        a += (there.vv * du - there.uv * dv) / area;
        b += (there.uu * dv - there.vu * du) / area;
        if (du * du + dv * dv < 1e-28) break;
    }
    return {a, b, 1.0};
}

SceneLens readOut(const SceneLens& whole, int cornerX, int cornerY, Size unbinned, int binning) {
    SceneLens part = whole;
    const double share = 1.0 / binning;
    part.size = {unbinned.width / binning, unbinned.height / binning};
    part.focalX *= share;
    part.focalY *= share;
    part.centreX = (part.centreX - cornerX) * share;
    part.centreY = (part.centreY - cornerY) * share;
    return part;
}

}  // namespace ilf::devices::scene
