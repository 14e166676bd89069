// A material's texture ready to be looked up: linear light, smaller copies for what is far away.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/solid/mesh.h"

namespace ilf {

class Texture {
public:
    /// Precondition: `material` has a texture of 3 channels.
    explicit Texture(const Material& material);

    Size size() const { return levels_.front().size; }
    /// Linear RGB at (u, v), bilinear on the copy whose texels are about as large as a pixel: `texels` of the full
    /// picture lie along a pixel's side there.
    std::array<float, 3> at(float u, float v, float texels) const;

private:
    struct Level {
        Size size;
        std::vector<std::uint16_t> linear;  ///< RGB, 65535 = 1
    };
    int wrapped(int i, int count, std::size_t axis) const;

    std::array<Material::Wrap, 2> wrap_;
    std::vector<Level> levels_;
};

}  // namespace ilf
