#include "core/perceived/seam_profile.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/perceived/seam_patch.h"

namespace ilf {
namespace {

using view::Block;
using view::Light;
using view::Lit;
using view::LitRegions;
using view::PatchWindow;

constexpr int kSamples = 129;
/// Longer ones are worked out on coarser pixels: no screen shows more.
constexpr double kMostReach = 200.0;

}  // namespace

std::optional<SeamProfile> seamProfile(const Compiled& compiled, Point<CameraFrame> cursor, double withinPixels) {
    const Plan& plan = compiled.plan;
    if (!compiled.document.scene.picture || !plan.sweeps() ||
        compiled.program.imageOfSlot.size() != plan.slots.size()) {
        return std::nullopt;
    }
    const LitRegions regions(compiled);
    const auto crossing = view::nearestCrossing(regions, cursor, withinPixels);
    if (!crossing) return std::nullopt;

    SeamProfile profile;
    profile.at = crossing->at();
    std::tie(profile.nx, profile.ny) = view::normalAt(regions, *crossing);
    const Lit& blurred = regions.all()[crossing->blurred];
    profile.blurred = blurred.region->id;
    profile.other = regions.all()[crossing->other].region->id;
    const auto distance = distanceAt(compiled.document, *blurred.region, profile.at);
    if (!distance) return std::nullopt;
    const auto behind = distanceAt(compiled.document, *regions.all()[crossing->other].region, profile.at);
    profile.depthStep = behind && abs(1.0 / *behind - 1.0 / *distance) > kDepthStep;
    const view::Displacement border =
        view::displacementAt(compiled, profile.at, profile.nx, profile.ny, *distance, *blurred.displaced);
    const auto millimetres = [&](double pixels) { return pixels / border.pixelsPerMetre * 1e3; };
    // Magnified light moves away from the centre: outwards over the neighbour (overlap) or away from it (gap).
    profile.gap = border.seam() < 0.0;
    profile.seamWidth_mm = millimetres(std::abs(border.seam()));

    const double reach = border.reach(compiled.document.seam);
    const auto window =
        PatchWindow::around(profile.at.x, profile.at.y, profile.at.x, profile.at.y,
                            reach + border.radius + border.shift + 3.0, std::max(1.0, reach / kMostReach));
    const auto surfaces = view::patchSurfaces(compiled.document, regions, profile.at, window);
    const auto before = view::hardLights(regions, plan, window), after = view::programLights(compiled, window);
    std::vector<Point<view::ViewFrame>> points;
    for (int i = 0; i < kSamples; ++i) {
        const double along = reach * (2.0 * i / (kSamples - 1) - 1.0);
        const Point<CameraFrame> point{profile.at.x + along * profile.nx, profile.at.y + along * profile.ny};
        if (!regions.inside(static_cast<int>(std::floor(point.x)), static_cast<int>(std::floor(point.y)))) continue;
        points.push_back(window.toPatch(point));
        profile.millimetres.push_back(static_cast<float>(millimetres(along)));
    }
    const auto across = [&](Eye eye, const std::vector<Light>& lights, double& worst) {
        const Block image =
            view::seenPatch(compiled, window, surfaces, lights, {eye, border.distance, border.distance, {}});
        std::vector<float> values;
        for (const auto& point : points) {
            values.push_back(view::sampled(image, point.x, point.y));
            worst = std::max(worst, std::abs(static_cast<double>(values.back()) - 1.0));
        }
        return values;
    };
    for (const Eye eye : {Eye::left, Eye::right}) {
        EyeProfile& one = eye == Eye::left ? profile.left : profile.right;
        one.before = across(eye, before, one.worstWeberBefore);
        one.after = across(eye, after, one.worstWeberAfter);
    }
    return profile;
}

}  // namespace ilf
