#include "core/perceived/attention.h"

#include <algorithm>
#include <cmath>

#include "core/document/region_at.h"
#include "core/optics/gaze.h"

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

PupilShift pupilShiftOf(const Document& document, const Plan& plan, const ViewRequest& request) {
    if (request.gaze != Gaze::fixed || plan.input.camera) return {};
    const Region* region = regionAt(document, request.gazeAt);
    const auto distance = distanceAt(document, region ? *region : *document.background, request.gazeAt);
    if (!distance) return {};
    // The eye turns about its centre of rotation, to where the point is seen through the lens at its focus power.
    const Point<CameraFrame> centre = opticalCentre(document, request.eye, *distance);
    const double perMetre = pixelsPerMetre(document, *distance);
    const double right = (request.gazeAt.x - centre.x) / perMetre, down = (request.gazeAt.y - centre.y) / perMetre;
    const double aside = std::hypot(right, down);
    if (aside == 0.0) return {};
    const double w = distance->si(), e = (plan.input.eye.lensToPupil + kPupilToRotationCentre).si();
    const double power = plan.focusPower.si();
    const Metre shift = pupilShift(std::atan(aside / (w + e - w * e * power)));
    return {shift * (right / aside), shift * (down / aside)};
}

Appearance appearance(const Document& document, const Plan& plan, const ViewRequest& request,
                      const Attention& attention, const ViewScale& scale, PixelRect<ViewFrame> window, Metre distance,
                      Dioptre lens, Dioptre colour) {
    const EyeOptics& optics = plan.input.eye;
    const double halfAngle = 0.5 * (optics.pupil * (seenDefocus(optics, attention, distance, lens) - colour));
    const double pixels = document.scene.scale.focalPixels * scale.nominal;
    // From the pupil through the lens's optical centre: where the surface does not move.
    const Point<CameraFrame> straight = opticalCentre(document, request.eye, distance);
    const PupilShift shift = pupilShiftOf(document, plan, request);
    const double aside = pixelsPerMetre(document, distance) * (distance / optics.lensToPupil);
    const Point<CameraFrame> centre{straight.x - aside * shift.right.si(), straight.y - aside * shift.down.si()};
    const bool turns = request.gaze == Gaze::follows && !plan.input.camera;
    const auto scaled = [&](Dioptre from) {
        return turns ? magnificationFrom(optics, MagnificationFrom::rotationCentre, {}, distance, from, lens)
                     : magnification(optics, distance, from, lens);
    };
    return {pixels * halfAngle / magnification(optics, distance, 0.0_D, lens), scaled(plan.focusPower),
            centre.x * scale.x - window.x0, centre.y * scale.y - window.y0};
}

}  // namespace ilf::view
