#include "ui/follow_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf::ui {

namespace {

/// Corners enough that an ellipse across a whole picture is off by less than a tenth of a pixel.
constexpr int kEllipseCorners = 256;

Outline outlineOf(const Shape& shape) {
    if (const auto* outline = std::get_if<Outline>(&shape)) return *outline;
    if (const auto* rectangle = std::get_if<Rectangle>(&shape)) {
        const auto &a = rectangle->a, &b = rectangle->b;
        return {{a, {b.x, a.y}, b, {a.x, b.y}}};
    }
    const auto& [a, b] = std::get<Ellipse>(shape);
    Outline outline;
    for (int i = 0; i < kEllipseCorners; ++i) {
        const double t = 2.0 * std::numbers::pi * i / kEllipseCorners;
        outline.vertices.push_back(
            {0.5 * (a.x + b.x) + 0.5 * (b.x - a.x) * std::cos(t), 0.5 * (a.y + b.y) + 0.5 * (b.y - a.y) * std::sin(t)});
    }
    return outline;
}

}  // namespace

Motion motionOf(const FollowView& view, const RegionId& region) {
    const auto found = std::ranges::find(view.motions, region, &RegionMotion::region);
    if (found == view.motions.end() || !(std::abs(found->motion.determinant()) > 1e-12)) return {};
    return found->motion;
}

Shape asPainted(const Shape& shown, const Motion& motion) {
    if (motion == Motion{}) return shown;
    Outline outline = outlineOf(shown);
    const Motion back = motion.inverted();
    for (auto& vertex : outline.vertices)
        vertex = back(vertex);
    return outline;
}

}  // namespace ilf::ui
