#include "core/track/quad.h"

#include <algorithm>
#include <cmath>

namespace ilf {

namespace {

double turn(const Point<CameraFrame>& a, const Point<CameraFrame>& b, const Point<CameraFrame>& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// From the unit square to the quad (P. Heckbert, "Fundamentals of texture mapping and image warping", 1989, 2.2.3).
std::optional<Motion> fromSquare(const Quad& q) {
    double size = 0.0;
    for (const auto& p : q)
        size = std::max(size, std::hypot(p.x - q[0].x, p.y - q[0].y));
    for (std::size_t i = 0; i < 4; ++i) {
        if (std::abs(turn(q[i], q[(i + 1) % 4], q[(i + 2) % 4])) <= 1e-9 * size * size) return std::nullopt;
    }
    const double sx = q[0].x - q[1].x + q[2].x - q[3].x, sy = q[0].y - q[1].y + q[2].y - q[3].y;
    const double ax = q[1].x - q[2].x, ay = q[1].y - q[2].y;
    const double bx = q[3].x - q[2].x, by = q[3].y - q[2].y;
    const double d = ax * by - bx * ay;
    const double g = (sx * by - bx * sy) / d, h = (ax * sy - sx * ay) / d;
    return Motion{{q[1].x - q[0].x + g * q[1].x, q[3].x - q[0].x + h * q[3].x, q[0].x,  //
                   q[1].y - q[0].y + g * q[1].y, q[3].y - q[0].y + h * q[3].y, q[0].y, g, h, 1.0}};
}

}  // namespace

std::optional<Motion> motionBetween(const Quad& from, const Quad& to) {
    const auto a = fromSquare(from), b = fromSquare(to);
    if (!a || !b || a->determinant() == 0.0) return std::nullopt;
    const auto back = a->inverted().m;
    Motion both;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            both.m[3 * i + j] = b->m[3 * i] * back[j] + b->m[3 * i + 1] * back[3 + j] + b->m[3 * i + 2] * back[6 + j];
    }
    if (both.m[8] == 0.0 || !std::isfinite(both.m[8])) return std::nullopt;
    const double scale = 1.0 / both.m[8];
    for (double& v : both.m)
        v *= scale;
    return both;
}

Quad cornersOf(const PixelRect<CameraFrame>& box) {
    const double x0 = box.x0, y0 = box.y0, x1 = box.x1, y1 = box.y1;
    return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

Quad moved(const Quad& quad, const Motion& motion) {
    Quad to;
    std::ranges::transform(quad, to.begin(), [&](const auto& p) { return motion(p); });
    return to;
}

Point<CameraFrame> middleOf(const Quad& q) {
    return {0.25 * (q[0].x + q[1].x + q[2].x + q[3].x), 0.25 * (q[0].y + q[1].y + q[2].y + q[3].y)};
}

double farthestCorner(const Quad& a, const Quad& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        most = std::max(most, std::hypot(a[i].x - b[i].x, a[i].y - b[i].y));
    return most;
}

double scaleAt(const Motion& motion, Point<CameraFrame> at) {
    const double w = motion.m[6] * at.x + motion.m[7] * at.y + motion.m[8];
    return std::sqrt(std::abs(motion.determinant() / (w * w * w)));
}

double signedArea(const Quad& q) { return 0.5 * (turn(q[0], q[1], q[2]) + turn(q[0], q[2], q[3])); }

PixelRect<CameraFrame> boxAround(const Quad& q) {
    const auto [left, right] = std::minmax({q[0].x, q[1].x, q[2].x, q[3].x});
    const auto [top, bottom] = std::minmax({q[0].y, q[1].y, q[2].y, q[3].y});
    // Far outside any picture is as good as the number itself.
    const auto whole = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
    return {whole(std::floor(left)), whole(std::floor(top)), whole(std::ceil(right)), whole(std::ceil(bottom))};
}

}  // namespace ilf
