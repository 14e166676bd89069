#include "core/perceived/seam_errors.h"

#include <algorithm>
#include <cmath>

namespace ilf {

Metre onSurface(const Document& document, double px, Metre distance) {
    const PixelMap map = pixelMap(document);
    const Size size = document.scene.size();
    const Point<ProjectorFrame> at = map.toProjector({0.5 * size.width, 0.5 * size.height});
    // The longer of the two ways a projector's pixel can lie in the picture.
    const Point<CameraFrame> here = map.toCamera(at), right = map.toCamera({at.x + 1.0, at.y}),
                             below = map.toCamera({at.x, at.y + 1.0});
    const double longest =
        std::max(std::hypot(right.x - here.x, right.y - here.y), std::hypot(below.x - here.x, below.y - here.y));
    return Metre::fromSi(px * longest / pixelsPerMetre(document, distance));
}

std::optional<Metre> knownRegistration(const Document& document, Metre distance) {
    const Box<Registration>& registration = document.rig.registration;
    const bool known = registration && registration->method != Registration::Method::typed &&
                       registration->rms_px > 0.0 && document.scene.picture && distance > 0.0_m;
    if (!known) return std::nullopt;
    const Metre shift = onSurface(document, registration->rms_px, distance);
    return isFinite(shift) ? std::optional(shift) : std::nullopt;
}

SeamErrors knownErrors(const Document& document, const Plan& plan) {
    SeamErrors errors;
    Metre farthest;
    for (const RegionPlan& region : plan.regions) {
        farthest = std::max(farthest, region.farthest);
        const double uncertain = 2.0 * region.sigma / region.nearest;
        errors.nearer = std::clamp(uncertain, errors.nearer, 0.9);
        errors.farther = std::max(errors.farther, uncertain);
    }
    if (const auto shift = knownRegistration(document, farthest)) {
        errors.registration = *shift;
        errors.coarseRegistration = 2.0 * *shift;
    }
    return errors;
}

}  // namespace ilf
