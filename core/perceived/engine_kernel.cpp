#include "core/perceived/engine_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf::view {

double tentUpTo(double x) {
    const double t = std::clamp(x, -1.0, 1.0);
    return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t);
}

namespace {

double boxUpTo(double x) { return std::clamp(x + 0.5, 0.0, 1.0); }

}  // namespace

EdgeKernel edgeKernel(double radius, const PupilCell& cell, PixelShape shape) {
    const double r = std::abs(radius);
    double x0 = cell.x0 * radius, x1 = cell.x1 * radius, y0 = cell.y0 * radius, y1 = cell.y1 * radius;
    if (radius < 0.0) {
        std::swap(x0, x1);
        std::swap(y0, y1);
    }
    EdgeKernel kernel;
    kernel.reach = static_cast<int>(std::ceil(r + 1.0));
    const int reach = kernel.reach, height = 2 * reach + 2;
    // derivative[dx + reach][dy + reach + 1] = k(dx, dy) - k(dx, dy + 1), dy from -reach - 1.
    std::vector<double> derivative(static_cast<std::size_t>((2 * reach + 1) * height));
    double area = 0.0;

    const auto upTo = [&](double x) { return shape == PixelShape::tent ? tentUpTo(x) : boxUpTo(x); };
    // Lines down the disc, evenly spaced in angle: the chords' square root has no corner there.
    const double from = std::asin(std::clamp(x0 / r, -1.0, 1.0)), to = std::asin(std::clamp(x1 / r, -1.0, 1.0));
    const double perPixel = shape == PixelShape::tent ? 24.0 : 48.0;
    const int lines = 24 + static_cast<int>(std::ceil(perPixel * r * (to - from) / std::numbers::pi));
    for (int i = 0; i < lines; ++i) {
        const double angle = from + (to - from) * (i + 0.5) / lines;
        const double x = r * std::sin(angle), half = r * std::cos(angle);
        const double below = std::max(-half, y0), above = std::min(half, y1);
        if (above <= below) continue;
        const double width = half * (to - from) / lines;  // dx = r cos(angle) d angle
        area += width * (above - below);
        const int left = static_cast<int>(std::floor(x));
        for (int side = 0; side < 2; ++side) {
            const int dx = left + side;
            const double share = shape == PixelShape::tent ? 1.0 - std::abs(x - dx) : std::lround(x) == dx ? 1.0 : 0.0;
            const double part = width * share;
            if (part <= 0.0 || dx < -reach || dx > reach) continue;
            double* column = derivative.data() + static_cast<std::size_t>((dx + reach) * height);
            for (const double end : {above, below}) {
                const double sign = end == above ? 1.0 : -1.0;
                const int at = static_cast<int>(std::floor(end));
                for (int dy = std::max(-reach - 1, at - 2); dy <= std::min(reach, at + 2); ++dy)
                    column[dy + reach + 1] += sign * part * (upTo(end - dy) - upTo(end - dy - 1));
            }
        }
    }
    kernel.area = area / (std::numbers::pi * r * r);
    if (area <= 0.0) return kernel;
    // As the steps have it, so that no light is lost: the sum of k is the sum of dy times its derivative.
    double sum = 0.0;
    for (int dx = -reach; dx <= reach; ++dx) {
        for (int dy = -reach - 1; dy <= reach; ++dy)
            sum += dy * derivative[static_cast<std::size_t>((dx + reach) * height + dy + reach + 1)];
    }
    for (int column = 0; column <= 2 * reach; ++column) {
        const double* steps = derivative.data() + static_cast<std::size_t>(column * height);
        const auto weight = [&](int row) { return row < 0 || row >= height ? 0.0 : steps[row] / sum; };
        // Row `row` of P serves output row i with the step that lies i rows further up.
        for (int row = 0; row < height + 3; ++row) {
            int first = 4, last = -1;
            EdgeKernel::Step step{row, column, {}};
            for (int i = 0; i < 4; ++i) {
                const double w = weight(row - i);
                if (std::abs(w) < 1e-9) continue;
                first = std::min(first, i);
                last = i;
                step.weights[static_cast<std::size_t>(i)] = static_cast<float>(w);
            }
            if (last < 0) continue;
            kernel.steps[static_cast<std::size_t>(first)][static_cast<std::size_t>(last - first)].push_back(step);
        }
    }
    return kernel;
}

}  // namespace ilf::view
