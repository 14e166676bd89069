// The rig for a picture that was just grabbed: its registration belongs to one mode of one camera.
#pragma once

#include "core/base/result.h"
#include "core/document/rig.h"

namespace ilf::app {

/// The rig with its registration converted to the mode that the picture was taken in: another part of the same sensor,
/// another binning or size. Refused in words where it cannot be converted, or is of another camera. A rig without a
/// registration, or with one that was typed for no camera in particular, is as it was.
Result<Rig> rigForGrabbed(const Rig& rig, CameraMode now, Size picture);

}  // namespace ilf::app
