// Inside the decoder: what one row of pictures says about where on the raster each pixel looks, pixel by pixel.
#pragma once

#include <cstdint>
#include <vector>

namespace ilf {

/// How many bits number `count` columns or rows; at least one.
int bitsFor(int count);

/// A row of a bit's picture and of its inverse's.
struct BitRows {
    const std::uint8_t* picture;
    const std::uint8_t* inverse;
};

/// One axis of one row of pixels. Differences are between a bit's picture and its inverse's, 0..255.
struct AxisRow {
    explicit AxisRow(int width);
    std::vector<std::int16_t> code;     ///< whole steps of the finest bit that was read
    std::vector<std::int16_t> weakest;  ///< least difference of all bits but the finest
    std::vector<std::int16_t> second;   ///< and the second least: only one bit may change at a place
    std::vector<std::int16_t> finest;   ///< of the finest bit, which changes at odd codes' beginnings
    std::vector<std::int16_t> even;     ///< of the bit that changes at the even end of this code; its contrast if none
};

/// Reads `bits`, most significant first, at least one. `contrast`: white above black.
///
/// A Gray code changes one bit at each whole step, so each step is the edge of just one bit: the finest bit's where an
/// odd step begins, a coarser one's where an even step begins. How clearly a pixel sees the two bits beside it tells
/// how far it is from either edge.
void readAxis(const std::vector<BitRows>& bits, const std::int16_t* contrast, int width, AxisRow& out);

/// Sub-pixel position in steps: nearer to the edge whose bit is seen less clearly.
///
///     x = odd edge +- |d_odd| / (|d_odd| + |d_even|)      d: bit against inverse
///
/// exact at both edges and half-way between, whatever the contrast; between them within 0.1 step for edges that blur
/// over 0.3 to 1 step.
inline float betweenEdges(int code, int finest, int even) {
    const float odd = static_cast<float>(finest) + 0.01f, other = static_cast<float>(even) + 0.01f;
    const float share = odd / (odd + other);
    return (code & 1) != 0 ? static_cast<float>(code) + share : static_cast<float>(code + 1) - share;
}

}  // namespace ilf
