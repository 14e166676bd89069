// Observers who judge pictures and know nothing of the optics that made them.
#pragma once

#include <cstdint>
#include <vector>

#include "app/evaluate/traced_camera.h"

namespace ilf::app {

/// What a camera's 8 bits make of the light: the brightest parts at level 200, shot and read noise, seeded. Assumed:
/// read noise 1.5 levels, shot noise 0.25 sqrt(level).
Image<std::uint8_t> exposed(const Image<float>& light, std::uint64_t seed);

struct FittedCircle {
    double x = 0.0, y = 0.0, radius = 0.0;  ///< pixels
};
/// As the paper measures: binarised by Otsu's method, a circle fitted (least squares) to the outline of each bright
/// blob of more than `leastArea` pixels; the nine nearest to the middle of the picture.
std::vector<FittedCircle> blurCircles(const Image<std::uint8_t>& picture, int leastArea = 5);

/// Reads the direction of a Landolt ring in four directions from what its receptors give: the direction whose sharp
/// ring, remembered, the picture resembles most.
class RingReader {
public:
    /// `gap_px`: the ring's gap in receptors, as it looks when sharp. `noise`: of one receptor, white being 1.
    RingReader(Size receptors, double gap_px, double noise, std::uint64_t seed);
    /// Every second of kRingDirections: right, up, left or down.
    int read(const Image<float>& light);

private:
    double noise_;
    std::uint64_t state_;
    std::vector<std::vector<float>> remembered_;  ///< one for each direction, mean 0
};

/// How much fine detail is left: mean square of the differences between neighbouring pixels in `part`, of `seen` as a
/// share of `sharp`. 1: all. Green channel.
double detailLeft(const Radiance& seen, const Radiance& sharp, int x0, int y0, int x1, int y1);

/// Light across an upright border at column `border`, as the eye receives it: for each column the mean over all rows of
/// `seen` as a share of that of `plain`, both first averaged over `window` columns. Green channel.
std::vector<double> lightAcross(const Radiance& seen, const Radiance& plain, int window);
/// Largest |I - 1| of it within `reach` columns of the border, signed: positive is brighter.
double weberAt(const std::vector<double>& profile, int border, int reach);

}  // namespace ilf::app
