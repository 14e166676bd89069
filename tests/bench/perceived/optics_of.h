// How a scene's surfaces look at the powers they are lit with: what baselines blur by, and how far a border reaches.
#pragma once

#include <vector>

#include "tests/bench/perceived/scenes.h"

namespace ilf::bench {

struct Seen {
    double radius = 0.0;  ///< of the disc on the surface, view pixels
    double magnification = 1.0;
    Point<CameraFrame> centre;
};
Seen seen(const BenchScene& scene, Metre distance, Dioptre power);

/// Share of the picture's own brightness that a level gives where its light is 1.
double weightOf(const Plan& plan, std::size_t level);

/// What the exact perimeter of every lit disc takes in the whole frame, in multiply-adds: 12 for each pixel of radius,
/// each lit pixel and each colour.
double perimeterSums(const BenchScene& scene);
/// Bytes that a whole frame cannot do without: reflectance and view as floats, one byte of light for each level.
double leastBytes(const BenchScene& scene);

/// 1 on pixels within the largest blur radius + 2 of a border between surfaces or of light; row by row.
std::vector<unsigned char> boundaryBand(const BenchScene& scene);

}  // namespace ilf::bench
