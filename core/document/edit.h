// Every edit an operator can make, as data, and the function that gives the next document.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/document/document.h"
#include "core/document/shape.h"
#include "core/document/stroke.h"

namespace ilf {

struct AddRegion {
    Region region;
    int index = 0;
};  ///< its mask may be empty: it becomes blank, the picture's size
struct RemoveRegion {
    RegionId region;
};
struct DuplicateRegion {
    RegionId region;
    RegionId copy;
};  ///< the copy lies above, named "... copy"
struct RenameRegion {
    RegionId region;
    std::string name;
};
struct MoveRegion {
    RegionId region;
    int index = 0;
};
struct SetLook {
    RegionId region;
    Look look = Look::focus;
};
struct SetStrength {
    RegionId region;
    std::optional<Dioptre> strength;
};
struct SetDistance {
    RegionId region;
    Distance distance;
};
struct SetVisible {
    RegionId region;
    bool on = true;
};
struct SetLocked {
    RegionId region;
    bool on = true;
};
struct SetSolo {
    RegionId region;
    bool on = true;
};

/// A part of a stroke. Folding the parts one after the other gives the stroke painted at once.
struct Paint {
    RegionId region;
    std::vector<Dab> dabs;
    PaintMode mode = PaintMode::add;
    bool protectOthers = false;
};
struct FillShape {
    RegionId region;
    Shape shape;
    PaintMode mode = PaintMode::add;
    bool protectOthers = false;
};
/// The region becomes this outline, whose vertices stay editable.
struct SetOutline {
    RegionId region;
    Outline outline;
};
/// The region's mask as a whole: what click-select, import and "grow" computed. `how` is the undo label.
struct SetMask {
    RegionId region;
    Mask mask;
    std::string how;
};
struct GrowMask {
    RegionId region;
    double radius = 0.0;
};  ///< camera pixels; negative shrinks
struct InvertMask {
    RegionId region;
};

struct SetSeam {
    Seam seam;
};
struct SetAlpha {
    Dioptre alpha;
};
/// Depth as the camera sees it; the distances from the wearer follow from it. Empty: the scene has no depth any more,
/// which is refused while a region reads its distance from it.
struct SetMeasuredDepth {
    Box<MeasuredDepth> measured;
};
/// Where the wearer stands; the distances of measured depth follow. Refused where nothing measured is in front of the
/// lens.
struct SetViewerPose {
    ViewerPose viewer;
};
/// What a region follows; absent: it stays where it was painted.
struct SetFollow {
    RegionId region;
    std::optional<Follow> follow;
};
/// Another unit for the scene's depth map: metres for each step of the whole numbers it was read from.
struct SetDepthScale {
    Metre metresPerUnit;
};
struct SetPixelScale {
    PixelScale scale;
};
/// Another picture beneath the regions. What lies on the old one (masks, outlines, points of planes, flat things that
/// are followed) goes along: as the camera's mode changed, or stretched where the size is another
/// (core/document/picture_change.h). Refused where a camera's picture lies nobody knows how in the old one.
struct SetScene {
    Scene scene;
};
struct SetWearer {
    Wearer wearer;
};
struct SetRig {
    Rig rig;
};
struct SetName {
    std::string name;
};

using Edit = std::variant<AddRegion, RemoveRegion, DuplicateRegion, RenameRegion, MoveRegion, SetLook, SetStrength,
                          SetDistance, SetVisible, SetLocked, SetSolo, Paint, FillShape, SetOutline, SetMask, GrowMask,
                          InvertMask, SetSeam, SetAlpha, SetMeasuredDepth, SetViewerPose, SetFollow, SetDepthScale,
                          SetPixelScale, SetScene, SetWearer, SetRig, SetName>;

/// The next document, or why there is none (no such region, locked, a number out of range ...). Arguments are values:
/// a refusal leaves everything as it was. Looks, strength and distance also take kBackgroundId.
Result<Document> edited(Document document, const Edit& edit);

/// What the undo menu calls it: "Paint", "Set distance" ...
std::string label(const Edit& edit);

/// Checks a wearer or rig typed or read from a file: every number finite and inside its range, with the sentence.
Result<void> checked(const Wearer& wearer);
Result<void> checked(const Rig& rig);
Result<void> checked(const Follow& follow, Size picture);
/// `spoken` names the distance in the sentence, e.g. "the distance of \"Face\"".
Result<void> checked(const Distance& distance, const std::string& spoken);

}  // namespace ilf
