#include "core/registration/pinhole.h"

#include <cmath>

namespace ilf {

namespace {

/// Brown's model: slopes as the lens bends them.
std::array<double, 2> bent(const std::array<double, 5>& d, double x, double y) {
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
    return {x * radial + 2.0 * d[2] * x * y + d[3] * (r2 + 2.0 * x * x),
            y * radial + d[2] * (r2 + 2.0 * y * y) + 2.0 * d[3] * x * y};
}

}  // namespace

std::array<double, 2> Pinhole::pixelOf(double slopeX, double slopeY) const {
    const auto [x, y] = bent(distortion, slopeX, slopeY);
    return {fx * x + cx, fy * y + cy};
}

std::array<double, 2> Pinhole::slopesOf(double px, double py) const {
    const double x = (px - cx) / fx, y = (py - cy) / fy;
    if (distortion == std::array<double, 5>{}) return {x, y};
    // Newton's steps with the bending's own derivative, by differences: it bends little, so a few are enough.
    double u = x, v = y;
    for (int step = 0; step < 20; ++step) {
        constexpr double kStep = 1e-6;
        const auto here = bent(distortion, u, v);
        const double ex = x - here[0], ey = y - here[1];
        if (std::abs(ex) + std::abs(ey) < 1e-13) break;
        const auto right = bent(distortion, u + kStep, v), below = bent(distortion, u, v + kStep);
        const double a = (right[0] - here[0]) / kStep, b = (below[0] - here[0]) / kStep;
        const double c = (right[1] - here[1]) / kStep, d = (below[1] - here[1]) / kStep;
        const double det = a * d - b * c;
        if (!(std::abs(det) > 1e-6)) break;
        u += (d * ex - b * ey) / det;
        v += (a * ey - c * ex) / det;
    }
    return {u, v};
}

Pinhole plainPinhole(Size size, double focalPixels) {
    return {size, focalPixels, focalPixels, 0.5 * size.width, 0.5 * size.height, {}};
}

}  // namespace ilf
