#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/perceived/prediction.h"

namespace ilf {
namespace {

constexpr int kSteps = 256;
/// A ramp or disc smaller than this is a step or a point.
constexpr double kNothing = 1e-7;

/// The integral up to `u` of a step at 0 that a disc of radius `radius` has blurred, max(0, u) for a point. Across a
/// straight border a disc weighs as 2 / pi sqrt(1 - t^2), t = u / radius.
double blurredRise(double u, double radius) {
    if (u <= -radius) return 0.0;
    if (u >= radius) return u;
    const double t = u / radius, root = std::sqrt(1.0 - t * t);
    return radius * (t * (0.5 + (std::asin(t) + t * root) / std::numbers::pi) +
                     2.0 / (3.0 * std::numbers::pi) * root * root * root);
}

/// S(radius, x): the ramp from -width / 2 to width / 2, blurred.
double blurredRamp(double x, double width, double radius) {
    return (blurredRise(x + 0.5 * width, radius) - blurredRise(x - 0.5 * width, radius)) / width;
}

}  // namespace

double seamOf(Metre width, Metre meant, Metre seen, Metre shift) {
    const double w = std::max(kNothing, width.si()), a = std::max(kNothing, meant.si()),
                 b = std::max(kNothing, seen.si()), away = std::abs(shift.si());
    const double reach = 0.5 * w + std::max(a, b) + away;
    double worst = 0.0;
    const auto look = [&](double x) {
        worst = std::max(worst, std::abs(blurredRamp(x + away, w, b) - blurredRamp(x, w, a)));
    };
    for (int i = 0; i <= kSteps; ++i)
        look(reach * (2.0 * i / kSteps - 1.0));
    // The border itself, and both ends of the ramp, where another disc leaves most.
    for (const double x : {-0.5 * away, -0.5 * w, 0.5 * w})
        look(x);
    return std::min(1.0, worst);  // a difference of nearly equal areas over a step may round above it
}

}  // namespace ilf
