// What a file puts into the emulated scene instead of the desk's own things.
#pragma once

#include <filesystem>
#include <functional>
#include <variant>

#include "core/base/box.h"
#include "core/base/result.h"
#include "core/document/viewer_pose.h"
#include "core/solid/mesh.h"
#include "devices/emulated_scene/scene_things.h"

namespace ilf::devices::scene {

/// A solid in its own metres, y up, or depth as some camera saw it.
using SceneFile = std::variant<Box<Solid>, Box<MeasuredDepth>>;
using SceneReader = std::function<Result<SceneFile>(const std::filesystem::path&)>;

/// Devices know no file formats: whoever does says so here, once, before the first camera is opened.
void readScenesWith(SceneReader reader);

/// The file as things. A solid stands on the desk, the middle of its box's underside where the rig looks, its z axis
/// towards whoever sits there. Depth lies where a camera in the place of the emulated one saw it, printed all over with
/// patches. `scale` times its lengths are metres. Refused: a file that cannot be read, nothing in it, and what the rig
/// cannot see as a whole or at all: solids smaller than 2 cm, wider than 1 m or higher than 0.4 m, depth whose middle
/// is nearer than 0.5 m or farther than 2.5 m.
Result<Things> sceneThings(const std::filesystem::path& path, double scale);
Result<Things> thingsOf(const SceneFile& file, double scale);

}  // namespace ilf::devices::scene
