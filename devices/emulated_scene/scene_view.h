// What a ray of the emulated scene's camera finds, and what is true there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "devices/emulated_scene/ray_tree.h"
#include "devices/emulated_scene/scene_lens.h"
#include "devices/emulated_scene/scene_things.h"

namespace ilf::devices::scene {

/// Camera, projector and what they look at.
struct Stage {
    SceneLens camera, projector;
    Placed cameraAt, projectorAt;
    Things things;
    /// Full light falls on a surface that faces the projector one metre away, lux.
    double projectorLux = 800.0;
    /// Of light that surfaces throw at each other, as a share of what they would: 1 is a grey room, 0 none.
    double bounce = 1.0;
};

/// What the scene is at a place of the camera's picture.
struct Truth {
    std::array<double, 2> projector{};  ///< raster coordinates there, on the raster or beside it
    double depth_m = 0.0;               ///< along the camera's axis
    Vec3 world;
    bool lit = false;  ///< the projector's light gets there
};

/// What one ray of the camera found.
struct Seen {
    std::int32_t surface = -1;  ///< -1: nothing
    std::int32_t look = 0;
    bool lit = false;
    float x = 0, y = 0;        ///< on the projector's raster
    float u = 0, v = 0;        ///< on the surface
    float depth = 0;           ///< along the camera's axis
    float lux = 0, shine = 0;  ///< of full light: falling on it, and thrown back as a highlight
};

/// Used by any thread; never changes.
class SceneView {
public:
    explicit SceneView(Stage stage) : stage_(std::move(stage)), tree_(stage_.things.triangles) {}

    const Stage& stage() const { return stage_; }
    const RayTree& tree() const { return tree_; }
    /// None where the camera sees nothing.
    std::optional<Truth> truth(double x, double y) const;
    Seen seen(double x, double y, Truth* truth = nullptr) const;

private:
    Stage stage_;
    RayTree tree_;
};

}  // namespace ilf::devices::scene
