// `gltf`: glTF scenes looked into and drawn to depth, from the command line.
#pragma once

#include <string>

namespace ilf::app {

/// Triangles, box, meshes, materials, cameras and what was repaired or ignored. A file that is refused is told as a
/// sentence (with `json` also as an object with "refused" and "problems"); exit code 1.
int gltfInfoCommand(const std::string& file, bool json);

struct GltfDepthOptions {
    std::string file;
    int camera = -1;      ///< one of the file's own, counted from 0
    std::string pose;     ///< "X,Y,Z,TX,TY,TZ": the camera's place and what it looks at, metres
    std::string pairs;    ///< CSV with columns x, y, z (scene) and u, v (picture, pixels): the pose that fits them
    double focal_px = 0;  ///< with `pose` or `pairs`; 0: from `fov_deg`
    double fov_deg = 40;  ///< from top to bottom
    std::string size = "1280x1024";
    double step_mm = 1.0;  ///< of a 16-bit PNG
    std::string out, colour;
};
/// Draws depth along the camera's axis. Without a camera, pose or pairs: from the front and above, all in view.
int gltfDepthCommand(const GltfDepthOptions& options);

}  // namespace ilf::app
