// glTF scenes (.gltf, .glb) read as solids: triangles in the scene's own metres, looks, and the cameras in the file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/base/result.h"
#include "core/registration/pinhole.h"
#include "core/solid/mesh.h"

namespace ilf::projects {

/// A camera that stands in the file's default scene.
struct GltfCamera {
    std::string name;           ///< the camera's, else its node's; may be empty
    bool orthographic = false;  ///< has no pinhole: its pose can be used, its view cannot be drawn
    double yfov = 0.0;          ///< radians; of perspective cameras
    std::optional<double> aspectRatio;
    Pose<CameraSpace, ModelSpace> cameraFromModel;

    /// The pinhole that sees this camera's view in a picture of that size: `yfov` from top to bottom, square pixels
    /// (as glTF asks of viewers whose shape differs from `aspectRatio`). Precondition: not orthographic.
    Pinhole pinhole(Size size) const;
};

/// The default scene (the first one where the file names none), at rest: no animation, skinning, morph targets or
/// instancing.
struct GltfScene {
    /// Meshes once for each node that shows them, moved to where the node puts them. Points and lines are kept as
    /// meshes without triangles: they count for the extent and are not drawn.
    Box<Solid> solid;
    std::vector<GltfCamera> cameras;
    std::string generator;              ///< the program that wrote the file, as the file says
    std::vector<std::string> problems;  ///< what was repaired, ignored or is not drawn: a sentence each
};

struct GltfReading {
    bool textures = true;  ///< base colour textures; depth needs none
};

/// Reads a scene (glTF 2.0; Draco, meshopt, quantised and sparse data). Files beside it are read only beneath its own
/// folder. Extents come from decoded vertices, never from what the file claims of them. Refused in words: whatever the
/// specification forbids (as glTF-Validator's errors), data that is missing or not numbers, extensions it requires and
/// this cannot do, and sizes beyond what a scene needs (20 million vertices or triangles, 1 GiB of data).
Result<GltfScene> readGltf(const std::filesystem::path& path, const GltfReading& reading = {});

}  // namespace ilf::projects
