#include "core/perceived/seam_light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ilf::view {
namespace {

/// Points of the unit disc, evenly spread on a spiral, each with its mirror image: ramps are summed exactly.
constexpr int kPairs = 40;
const std::array<std::array<float, 2>, kPairs>& discPoints() {
    static const auto made = [] {
        std::array<std::array<float, 2>, kPairs> points{};
        constexpr double kGoldenAngle = 2.399963229728653;
        for (int i = 0; i < kPairs; ++i) {
            const double r = std::sqrt((i + 0.5) / kPairs), a = kGoldenAngle * i;
            points[static_cast<std::size_t>(i)] = {static_cast<float>(r * std::cos(a)),
                                                   static_cast<float>(r * std::sin(a))};
        }
        return points;
    }();
    return made;
}

/// A disc this small is a point.
constexpr double kPoint = 0.05;

}  // namespace

SeamLight::SeamLight(const Compiled& compiled, const Program& program, const PixelRect<CameraFrame>& box)
    : compiled_(compiled), map_(pixelMap(compiled.document)) {
    const Plan& plan = compiled.plan;
    weights_.assign(plan.levels.size(), 0.0);
    for (const Slot& slot : plan.slots) {
        for (const LevelLight& lit : slot.lit) {
            weights_[static_cast<std::size_t>(lit.level)] +=
                lit.weight / (static_cast<double>(plan.slots.size()) * plan.light);
        }
    }
    PatchWindow window;
    window.x0 = box.x0;
    window.y0 = box.y0;
    window.size = {box.width(), box.height()};
    const auto under = rasterUnder(window, map_, program.projector);
    for (std::size_t l = 0; l < weights_.size(); ++l) {
        const bool lit = weights_[l] > 0.0 && l < program.images.size();
        if (!lit) weights_[l] = 0.0;
        images_.push_back(lit ? gathered(program.images[l], under) : Patch<std::uint8_t>());
    }
}

SeamLight::View SeamLight::view(const Looking& looking) const {
    const Document& document = compiled_.document;
    View view;
    const double pixels = pixelsPerMetre(document, looking.centreDistance);
    const Point<CameraFrame> centre = opticalCentre(document, looking.eye, looking.centreDistance);
    view.centre = {centre.x + pixels * looking.off.centreX.si(), centre.y + pixels * looking.off.centreY.si()};
    for (const Level& level : compiled_.plan.levels) {
        const Seen seen = seenThrough(compiled_.plan, looking, looking.centreDistance, level.power);
        const bool moves = abs(level.power - compiled_.plan.focusPower) > 1e-4_D;
        view.levels.push_back({std::abs(pixels * seen.radius.si()), seen.magnification,
                               moves ? pixels * looking.off.registrationX.si() : 0.0,
                               moves ? pixels * looking.off.registrationY.si() : 0.0});
    }
    return view;
}

double SeamLight::level(std::size_t l, Point<ProjectorFrame> p) const {
    const Patch<std::uint8_t>& image = images_[l];
    const double u = std::clamp(p.x - 0.5, static_cast<double>(image.at.x0), image.at.x1 - 1.001);
    const double v = std::clamp(p.y - 0.5, static_cast<double>(image.at.y0), image.at.y1 - 1.001);
    const int i = static_cast<int>(u + 4096.0) - 4096, j = static_cast<int>(v + 4096.0) - 4096;
    const double fx = u - i, fy = v - j;
    const std::uint8_t* a = image.row(j) + (i - image.at.x0);
    const std::uint8_t* b = a + image.at.width();
    const double top = a[0] + fx * (a[1] - a[0]), bottom = b[0] + fx * (b[1] - b[0]);
    return top + fy * (bottom - top);
}

double SeamLight::at(Point<CameraFrame> p, const View& view) const {
    double sum = 0.0;
    for (std::size_t l = 0; l < weights_.size(); ++l) {
        if (weights_[l] == 0.0) continue;
        const View::Level& one = view.levels[l];
        const Point<CameraFrame> lit{view.centre.x + (p.x - view.centre.x) / one.magnification - one.movedX,
                                     view.centre.y + (p.y - view.centre.y) / one.magnification - one.movedY};
        const Point<ProjectorFrame> middle = map_.toProjector(lit);
        if (one.radius < kPoint) {
            sum += weights_[l] * level(l, middle) / 255.0;
            continue;
        }
        // The raster is even over a disc: its two axes serve all points.
        const auto x = map_.toProjector({lit.x + one.radius, lit.y}), y = map_.toProjector({lit.x, lit.y + one.radius});
        const double xx = x.x - middle.x, xy = x.y - middle.y, yx = y.x - middle.x, yy = y.y - middle.y;
        double light = 0.0;
        for (const auto& [qx, qy] : discPoints()) {
            const double dx = static_cast<double>(qx) * xx + static_cast<double>(qy) * yx;
            const double dy = static_cast<double>(qx) * xy + static_cast<double>(qy) * yy;
            light += level(l, {middle.x + dx, middle.y + dy}) + level(l, {middle.x - dx, middle.y - dy});
        }
        sum += weights_[l] * light / (255.0 * 2.0 * kPairs);
    }
    return sum;
}

}  // namespace ilf::view
