// Convolution of interleaved floats with a disc of any radius, exact to its partly covered pixels.
#pragma once

#include <vector>

namespace ilf::view {

/// A block of interleaved floats, row-major, without padding.
struct Block {
    int width = 0, height = 0, channels = 1;
    std::vector<float> values;

    Block() = default;
    Block(int w, int h, int c)
        : width(w), height(h), channels(c),
          values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}
    std::size_t stride() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels); }
    float* row(int y) { return values.data() + static_cast<std::size_t>(y) * stride(); }
    const float* row(int y) const { return values.data() + static_cast<std::size_t>(y) * stride(); }
};

/// How far a disc of `radius` pixels reaches, in whole pixels.
int discReach(double radius);

/// `block` blurred by the disc of `radius` pixels (uniform, integral 1). Between pixel centres `block` is bilinear,
/// so each pixel weighs as what the disc holds of its tent, and a disc of radius 0 changes nothing.
/// The result is larger by discReach on every side; outside `block` all is 0.
///
/// A row of the kernel is flat but for its two ends, so over running sums of the row only the ends count: 12 r products
/// a pixel instead of pi r^2 (the "edge" kernel).
Block discBlurred(const Block& block, double radius);

}  // namespace ilf::view
