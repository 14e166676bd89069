// What a panel shows of regions that follow something, and the way between where they are painted and where they are
// shown.
#pragma once

#include <string>
#include <vector>

#include "core/document/shape.h"
#include "core/track/region_tracker.h"

namespace ilf::ui {

/// A printed marker that was found in a picture.
struct MarkerFound {
    std::string dictionary;
    int id = 0;
    Point<CameraFrame> middle;
    bool inScene = false;  ///< in the picture that regions were painted on, where it must be to be followed
    bool operator==(const MarkerFound&) const = default;
};

struct FollowView {
    std::vector<FollowedNow> regions;  ///< those that follow something
    bool camera = false;               ///< a live picture is looked at
    int oscPort = 0;                   ///< poses are heard there; 0: none are
    bool looking = false;              ///< markers are being looked for
    bool looked = false;               ///< `markers` is what was found last
    std::vector<MarkerFound> markers;
    bool behind = false;  ///< what follows in the light is as it was put on show: edits wait
    /// What is drawn and clicked: the document with what follows where the live picture shows it. Null: as it is
    /// painted.
    const Document* shown = nullptr;
    std::vector<RegionMotion> motions;  ///< from where regions are painted to where they are `shown`
};

/// From where a region is painted to where it is shown; the identity for those that do not move, and where there is no
/// way back.
Motion motionOf(const FollowView& view, const RegionId& region);
/// The shape of what is drawn over the picture, where the region is painted: outlines whose corners went along.
Shape asPainted(const Shape& shown, const Motion& motion);

}  // namespace ilf::ui
