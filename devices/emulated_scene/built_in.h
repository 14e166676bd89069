// The built-in rig of the emulated scene: where camera and projector stand over the desk, and their lenses.
#pragma once

#include "devices/emulated_scene/light_transport.h"

namespace ilf::devices::scene {

/// 1280 x 1024, some 31 degrees across, 1.1 m from the desk it looks down at.
SceneLens builtInCamera();
/// Of any raster: the picture it throws has the same outline (16:10 where 912 x 1140 mirrors stand in a diamond,
/// otherwise pixels are square), wider than what the camera sees but for one corner.
SceneLens builtInProjector(Size raster);
Placed builtInCameraAt();
Placed builtInProjectorAt();
/// The desk with them. `board`: 0 the desk's own things, else the chessboard in that pose above it.
Stage builtInStage(Size raster, int board = 0);

}  // namespace ilf::devices::scene
