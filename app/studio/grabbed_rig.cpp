#include "app/studio/grabbed_rig.h"

#include <utility>

#include "core/document/picture_change.h"
#include "core/registration/convert.h"

namespace ilf::app {
namespace {

bool painted(const Document& document, const RegionId& id) {
    const Region* region = findRegion(document, id);
    return region != nullptr && !region->mask.empty() && !region->mask.blank();
}

/// Names of the regions that the new picture shows nothing of, in quotes, with commas between them.
std::string leftBehind(const Document& before, const Document& after) {
    std::string names;
    for (const Box<Region>& region : before.regions) {
        if (!painted(before, region->id) || painted(after, region->id)) continue;
        names += (names.empty() ? "\"" : ", \"") + region->name + "\"";
    }
    return names;
}

}  // namespace

Result<Rig> rigForGrabbed(const Rig& rig, const CameraMode& now) {
    if (!rig.registration) return rig;
    auto converted = convertedTo(*rig.registration, now);
    if (!converted) return tl::unexpected(converted.error());
    if (*converted == *rig.registration) return rig;
    Rig fitting = rig;
    const CameraMode& before = rig.registration->camera;
    const auto change = oldFromNew(before, now);
    if (change && rig.calibration && rig.calibration->camera.size == before.picture && now.picture != Size{}) {
        ProcamCalibration calibration = *rig.calibration;
        calibration.camera = convertedBy(calibration.camera, *change, now.picture);
        if (!(calibration == *rig.calibration)) fitting.calibration = Box(std::move(calibration));
    }
    fitting.registration = Box(*std::move(converted));
    return fitting;
}

Result<Grab> grabbed(const Document& document, Scene scene) {
    const bool ofCamera = scene.camera.picture != Size{};
    auto rig = ofCamera ? rigForGrabbed(document.rig, scene.camera) : Result<Rig>(document.rig);
    if (!rig) return tl::unexpected(rig.error());
    Grab grab;
    // The scene first: of an older project the registration before knows in which mode its picture was taken.
    grab.edits.emplace_back(SetScene{carriedOver(document, std::move(scene))});
    auto after = edited(document, grab.edits.front());
    if (!after) return tl::unexpected(after.error());
    if (!rig->registration.same(document.rig.registration)) {
        grab.edits.emplace_back(SetRig{*std::move(rig)});
        grab.note = "The camera's mode has changed: the registration was converted to it, and the regions went along.";
    }
    if (const std::string names = leftBehind(document, *after); !names.empty()) {
        grab.note += std::string(grab.note.empty() ? "" : " ") + "The picture shows nothing of " + names +
                     ": undo brings the paint back.";
    }
    if (document.scene.depth && !after->scene.depth) {
        grab.note += std::string(grab.note.empty() ? "" : " ") +
                     "Depth is not known for this picture: scan again where distances come from it.";
    }
    return grab;
}

}  // namespace ilf::app
