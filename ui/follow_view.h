// What a panel shows of regions that follow something.
#pragma once

#include <string>
#include <vector>

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
};

}  // namespace ilf::ui
