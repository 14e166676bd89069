// How the projector's light reaches each camera pixel of the emulated scene, worked out once for each scene and pose.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "devices/emulated_scene/scene_view.h"

namespace ilf::devices::scene {

/// Used by any thread; never changes.
class LightTransport {
public:
    /// Seconds of rays. Where `stop` is requested meanwhile it ends at once, and what there is then is not to be used.
    explicit LightTransport(Stage stage, const std::stop_token& stop = {});
    ~LightTransport();
    LightTransport(const LightTransport&) = delete;
    LightTransport& operator=(const LightTransport&) = delete;

    const Stage& stage() const;
    /// As of SceneView.
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
