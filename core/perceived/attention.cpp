#include "core/perceived/attention.h"

#include <algorithm>

namespace ilf::view {
namespace {

Attention attending(const EyeOptics& eye, const RegionPlan& region) {
    const Dioptre needed = -defocus(eye, region.nearest, region.levelPower);
    const Dioptre amount = std::clamp(needed, 0.0_D, eye.accommodation);
    return {amount == needed, region.nearest, region.levelPower, amount};
}

}  // namespace

Result<Attention> attention(const Plan& plan, const ViewRequest& request) {
    const EyeOptics& eye = plan.input.eye;
    if (plan.input.camera) return Attention{};
    if (request.attending) {
        const auto region = std::ranges::find(plan.regions, *request.attending, &RegionPlan::id);
        if (region == plan.regions.end()) {
            return fail(Fault::notFound, "The region to look at is not part of the scene.");
        }
        return attending(eye, *region);
    }
    const RegionPlan* nearest = nullptr;
    for (const RegionPlan& region : plan.regions) {
        if (region.look != Look::focus || !region.problem.empty()) continue;
        if (!nearest || region.nearest < nearest->nearest) nearest = &region;
    }
    return nearest ? attending(eye, *nearest) : Attention{};
}

Dioptre seenDefocus(const EyeOptics& eye, const Attention& attention, Metre distance, Dioptre lens) {
    return attention.holds ? defocusAttending(eye, distance, lens, attention.attended, attention.lens)
                           : defocus(eye, distance, lens, attention.amount);
}

Appearance appearance(const Document& document, const Plan& plan, Eye eye, const Attention& attention,
                      const ViewScale& scale, PixelRect<ViewFrame> window, Metre distance, Dioptre lens) {
    const EyeOptics& optics = plan.input.eye;
    const double halfAngle = 0.5 * (optics.pupil * seenDefocus(optics, attention, distance, lens));
    const double pixels = document.scene.scale.focalPixels * scale.nominal;
    const Point<CameraFrame> centre = opticalCentre(document, eye, distance);
    return {pixels * halfAngle / magnification(optics, distance, 0.0_D, lens),
            magnification(optics, distance, plan.focusPower, lens), centre.x * scale.x - window.x0,
            centre.y * scale.y - window.y0};
}

}  // namespace ilf::view
