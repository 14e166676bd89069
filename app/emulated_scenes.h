// Files for the emulated scene: devices know no formats, so the programs tell them who reads these.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "devices/emulated_scene/scene_file.h"

namespace ilf::app {

/// glTF by its ending (.glb, .gltf), anything else as depth; depth is taken as seen through the emulated camera's lens,
/// of whatever size the file has.
Result<devices::scene::SceneFile> sceneFile(const std::filesystem::path& path);

/// From now on "emulated:scene=FILE" finds its files. Once, before other threads begin.
void readEmulatedScenes();

/// Tells the emulated cameras of this session what to see from now on, also one that is open. Refused: words that are
/// none, a scene's file that cannot be used. Empty: nothing is told.
Result<void> wishedOfCamera(const std::string& words);

}  // namespace ilf::app
