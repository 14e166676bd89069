// Inside the decoder: each pixel's place is judged and steadied by the places of the pixels around it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace ilf {

/// Places on the raster, as they are decoded: x and y of each camera pixel, and whether it has one.
struct Places {
    Size camera;
    std::vector<float> at;            ///< x, y, ...
    std::vector<std::uint8_t> state;  ///< PixelState
};

/// x and y on the raster as a linear function of the camera pixel: {x: 1, i, j; y: 1, i, j}.
using Trend = std::array<double, 6>;
/// What fits a sample of the decoded pixels best, with outliers weighed down. Zero where there are fewer than three.
Trend trendOf(const Places& places);

/// A pixel agrees with another when they leave the trend by the same, to within `within` (x, y; raster pixels). Pixels
/// that agree with too few of those around them become inconsistent, each other moves to the mean of those it agrees
/// with, which is what takes out the steps of the code. The answer is each pixel's share of neighbours that agree,
/// 0..255.
std::vector<std::uint8_t> steadied(Places& places, const Trend& trend, std::array<double, 2> within);

/// Islands of a few pixels in shadow or gloss are chance: where less than an eighth of some 24 x 24 pixels is decoded,
/// those become inconsistent.
void withoutIslands(Places& places);

}  // namespace ilf
