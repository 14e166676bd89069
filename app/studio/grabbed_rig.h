// What a picture that was just grabbed does to a document: its registration belongs to one mode of one camera.
#pragma once

#include <string>
#include <vector>

#include "core/document/edit.h"

namespace ilf::app {

/// The edits of one gesture, and what the operator should know of them; empty: nothing that is not plain to see.
struct Grab {
    std::vector<Edit> edits;
    std::string note;
};

/// `scene` beneath the regions: what is painted, distances and depth go along with the things (picture_change.h), and
/// the rig's registration and camera are converted to the mode that the picture was taken in: another part of the same
/// sensor, another binning or size. Refused in words where one of these cannot be, or the registration is of another
/// camera. A picture of no camera leaves the rig as it is, as does a rig without a registration, or with one that was
/// typed for no camera in particular.
Result<Grab> grabbed(const Document& document, Scene scene);

/// The rig for pictures in the mode `now`, as above; the same registration where nothing changes.
Result<Rig> rigForGrabbed(const Rig& rig, const CameraMode& now);

}  // namespace ilf::app
