// Blur kernels as the steps along their rims, for running sums down the columns: 12 r products a pixel, not pi r^2.
#pragma once

#include <array>
#include <vector>

namespace ilf::view {

/// A part of the pupil in units of its radius: [x0, x1] x [y0, y1] within the unit disc.
struct PupilCell {
    double x0 = -1.0, y0 = -1.0, x1 = 1.0, y1 = 1.0;
    bool operator==(const PupilCell&) const = default;
};

/// A disc (or the part of it that a cell of the pupil casts), laid over pixels whose values are bilinear in between.
/// Integral 1.
///
/// With P the running sums down the columns of a picture S, the blurred pixel (x, y) is the sum of w P(y + dy, x + dx)
/// over the few steps (dx, dy, w) where a column of the kernel begins or ends. Steps are kept for four rows at once, by
/// how many of them one sum serves, so that it is loaded once.
struct EdgeKernel {
    int reach = 0;      ///< whole pixels it reaches to every side
    double area = 0.0;  ///< share of the disc's light that this cell passes (1 for the whole disc)
    struct Step {
        int row = 0, column = 0;  ///< of P, from the window's corner: 0..2 reach + 4, 0..2 reach
        std::array<float, 4> weights{};
    };
    /// By [first row served][rows served - 1].
    std::array<std::array<std::vector<Step>, 4>, 4> steps;
};

/// What a pixel stands for: bilinear between pixels, or uniform (its rim is thinner: a third fewer steps; averaged
/// pictures, whose interpolation is fitted to it, take this one).
enum class PixelShape { tent, box };

/// Integral of a pixel's tent (1 at its centre, 0 one pixel away) from the left up to `x`.
double tentUpTo(double x);

/// `radius` in pixels, signed: negative turns the cell about the middle. Precondition: radius is not 0.
EdgeKernel edgeKernel(double radius, const PupilCell& cell = {}, PixelShape shape = PixelShape::tent);

}  // namespace ilf::view
