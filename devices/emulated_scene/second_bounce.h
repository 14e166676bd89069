// Light that lit surfaces throw at each other: one further bounce between patches of what the camera sees.
#pragma once

#include <cstdint>
#include <vector>

#include "devices/emulated_scene/ray_tree.h"

namespace ilf::devices::scene {

/// Patches are squares of camera pixels; each throws what its pixels send, evenly in all directions (Lambert), to those
/// it faces and that nothing hides. Surfaces that the camera does not see throw nothing.
class SecondBounce {
public:
    static constexpr int kPatch = 32;  ///< pixels along a side

    SecondBounce() = default;
    SecondBounce(const RayTree& tree, const SceneLens& camera, const Placed& cameraAt, double share);

    /// Lux that fall on each patch by way of the others, of what each pixel sends; empty: none do.
    std::vector<float> fallingOn(const std::vector<float>& sent) const;
    /// That at a pixel, between patches.
    float at(const std::vector<float>& falling, int x, int y) const;

private:
    struct Exchange {
        std::uint16_t to, from;
        float factor;
    };
    Size size_;
    int across_ = 0, down_ = 0;
    std::vector<Exchange> exchanges_;
};

}  // namespace ilf::devices::scene
