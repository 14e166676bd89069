#include "core/perceived/reference_rays.h"

#include <algorithm>
#include <cmath>

#include "core/document/region_at.h"
#include "core/optics/chromatic.h"
#include "core/optics/gaze.h"

namespace ilf::reference {
namespace {

/// What the eye accommodates to: the region asked for, else the nearest focused one.
Result<const RegionPlan*> attended(const Plan& plan, const ViewRequest& request) {
    if (request.attending) {
        const auto region = std::ranges::find(plan.regions, *request.attending, &RegionPlan::id);
        if (region == plan.regions.end())
            return fail(Fault::notFound, "The region to look at is not part of the scene.");
        return &*region;
    }
    const RegionPlan* nearest = nullptr;
    for (const RegionPlan& region : plan.regions) {
        if (region.look != Look::focus || !region.problem.empty()) continue;
        if (!nearest || region.nearest < nearest->nearest) nearest = &region;
    }
    return nearest;
}

/// Surplus power of an eye that does what it can to see `region` sharp through its level's power.
double accommodated(const EyeOptics& eye, const RegionPlan* region) {
    const double relaxed = -eye.ametropia.si();
    if (!region) return relaxed;
    // A point is sharp when every ray of its bundle comes from it, whatever its height in the pupil.
    const RayMatrix back = backTo(region->nearest.si(), region->levelPower.si(), eye.lensToPupil.si());
    return std::clamp(-back.a / back.b, relaxed, relaxed + eye.accommodation.si());
}

/// Distance of what the picture shows at a point.
std::optional<Metre> shownAt(const Document& document, Point<CameraFrame> at) {
    if (const Region* region = regionAt(document, at)) return distanceAt(document, *region, at);
    return document.background ? distanceAt(document, *document.background, at) : std::nullopt;
}

/// Where the pupil goes when the eye turns until it points at what the picture shows there.
Result<Pair> turnedTo(const Document& document, const Optics& eye, Point<CameraFrame> at) {
    const Size size = document.scene.size();
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < size.width && at.y < size.height))
        return fail(Fault::outOfRange, "The eye cannot be turned to a point outside the picture.");
    const auto distance = shownAt(document, at);
    if (!distance) return fail(Fault::notFound, "Nothing is known of the distance of the point the eye is turned to.");
    Optics turning = eye;
    turning.turning = kPupilToRotationCentre.si();
    const Pair view{at.x * eye.frame.perPictureX, at.y * eye.frame.perPictureY};
    const Pair slope = chiefRay(turning, view, distance->si()).slope;
    // The pupil stays on a sphere about the centre of rotation. Light that comes down onto the lens's axis with a
    // positive slope started below it.
    const double tangent = std::hypot(slope.x, slope.y);
    if (tangent == 0.0) return Pair{};
    const double shift = pupilShift(std::atan(tangent)).si();
    return Pair{-shift * slope.x / tangent, -shift * slope.y / tangent};
}

}  // namespace

Result<Optics> optics(const Document& document, const Plan& plan, const ViewRequest& request, const Frame& frame) {
    const EyeOptics& eye = plan.input.eye;
    const bool camera = plan.input.camera;
    const auto region = attended(plan, camera ? ViewRequest{} : request);
    if (!region) return tl::unexpected(region.error());

    Optics made;
    made.lensToPupil = eye.lensToPupil.si();
    made.pupilRadius = 0.5 * eye.pupil.si();
    made.restPower = plan.focusPower.si();
    made.surplus.fill(accommodated(eye, camera ? nullptr : *region));
    const LensAxis& lens = document.wearer.axis(request.eye);
    made.lens = {lens.right.si(), lens.down.si()};
    const Point<CameraFrame> axis = cameraAxis(document);
    made.axis = {axis.x, axis.y};
    made.focalPixels = document.scene.scale.focalPixels;
    made.frame = frame;
    if (camera) return made;

    if (request.chromatic && plan.input.rig.primaries) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto refraction = chromaticRefraction((*plan.input.rig.primaries)[c]);
            if (!refraction) return tl::unexpected(refraction.error());
            made.surplus[c] -= refraction->si();
        }
    }
    if (request.lensField) made.rim = 0.5 * document.wearer.lensAperture.si();
    if (request.gaze == Gaze::follows) made.turning = kPupilToRotationCentre.si();
    if (request.gaze == Gaze::fixed) {
        const auto pupil = turnedTo(document, made, request.gazeAt);
        if (!pupil) return tl::unexpected(pupil.error());
        made.pupil = *pupil;
    }
    return made;
}

ChiefRay chiefRay(const Optics& optics, Pair view, double distance) {
    const Pair at = Shown(optics, distance).metres(view);
    // The chief ray passes the pupil's centre, or, if the eye turns along, its centre of rotation behind it.
    const RayMatrix back = backTo(distance, optics.restPower, optics.lensToPupil) * travel(-optics.turning);
    const Pair through = optics.turning > 0.0 ? Pair{} : optics.pupil;
    const Pair slope{(at.x - back.a * through.x) / back.b, (at.y - back.a * through.y) / back.b};
    return {{through.x - optics.turning * slope.x, through.y - optics.turning * slope.y}, slope};
}

bool pastRim(const Optics& optics, const ChiefRay& chief, Pair aside, double surplus) {
    const RayMatrix back = travel(-optics.lensToPupil);
    const double x = (back * Ray{chief.height.x + aside.x, chief.slope.x + surplus * aside.x}).height;
    const double y = (back * Ray{chief.height.y + aside.y, chief.slope.y + surplus * aside.y}).height;
    return x * x + y * y > *optics.rim * *optics.rim;
}

}  // namespace ilf::reference
