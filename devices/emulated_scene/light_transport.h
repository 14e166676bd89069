// How the projector's light reaches each camera pixel of the emulated scene, worked out once for each scene and pose.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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

/// Used by any thread; never changes.
class LightTransport {
public:
    explicit LightTransport(Stage stage);
    ~LightTransport();
    LightTransport(const LightTransport&) = delete;
    LightTransport& operator=(const LightTransport&) = delete;

    const Stage& stage() const;
    /// None where the camera sees nothing.
    std::optional<Truth> truth(double x, double y) const;

    /// `light`: the projector's raster, row by row, 1 = full. Gives what each camera pixel sends to the sensor, as lux
    /// of white light on a white surface: `out[i]`, without colour.
    void shine(const std::vector<float>& light, double ambientLux, std::vector<float>& out) const;
    /// Colour of each camera pixel relative to its luminance: 3 numbers, 64 = 1.
    const std::vector<std::uint8_t>& tint() const;
    /// Albedo of each camera pixel as `shine` weighs it; 0 where there is nothing.
    const std::vector<float>& albedo() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ilf::devices::scene
