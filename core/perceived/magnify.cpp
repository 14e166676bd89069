#include "core/perceived/magnify.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace ilf::view {
namespace {

/// Four consecutive source pixels and their weights; the first may lie outside.
struct FourTaps {
    int first = 0;
    std::array<float, 4> weights{};
};

FourTaps bilinearAt(double source) {
    const double left = std::floor(source);
    const auto t = static_cast<float>(source - left);
    return {static_cast<int>(left) - 1, {0.0F, 1.0F - t, t, 0.0F}};
}

FourTaps cubicAt(double source) {
    const double left = std::floor(source);
    const double t = source - left, t2 = t * t, t3 = t2 * t;
    return {static_cast<int>(left) - 1,
            {static_cast<float>(-0.5 * t3 + t2 - 0.5 * t), static_cast<float>(1.5 * t3 - 2.5 * t2 + 1.0),
             static_cast<float>(-1.5 * t3 + 2.0 * t2 + 0.5 * t), static_cast<float>(0.5 * t3 - 0.5 * t2)}};
}

/// One axis of the map from window to block: block pixel = (centre + (window - centre) / s - origin) / pitch - 1/2.
struct Axis {
    double centre, origin, pitch, magnification;
    double source(int pixel) const { return (centre + (pixel + 0.5 - centre) / magnification - origin) / pitch - 0.5; }
    /// Window pixels that a block of `length` pixels can reach.
    std::pair<int, int> reached(int length, int limit) const {
        const double from = centre + (origin - pitch - centre) * magnification;
        const double to = centre + (origin + (length + 1) * pitch - centre) * magnification;
        return {std::clamp(static_cast<int>(std::floor(from)), 0, limit),
                std::clamp(static_cast<int>(std::ceil(to)), 0, limit)};
    }
};

}  // namespace

void addMagnified(Block& into, Block* opacity, const Block& passing, const Block& block, Placement placement,
                  const Appearance& look, bool sharp, int colours, float weight) {
    const auto resample = sharp ? bilinearAt : cubicAt;
    const Axis across{look.centreX, placement.x, placement.pitch, look.magnification};
    const Axis down{look.centreY, placement.y, placement.pitch, look.magnification};
    const auto [x0, x1] = across.reached(block.width, into.width);
    const auto [y0, y1] = down.reached(block.height, into.height);
    if (x1 <= x0 || y1 <= y0) return;

    std::vector<FourTaps> columns;
    for (int x = x0; x < x1; ++x)
        columns.push_back(resample(across.source(x)));
    const auto channels = static_cast<std::size_t>(block.channels);
    const auto colourCount = static_cast<std::size_t>(colours);
    parallelFor(y1 - y0, [&, y0 = y0, x0 = x0, x1 = x1](int r) {
        const int y = y0 + r;
        const FourTaps rows = resample(down.source(y));
        // Three pixels of nothing on both sides: no column needs a case.
        constexpr std::size_t kMargin = 3;
        std::vector<float> line(block.stride() + 2 * kMargin * channels);
        for (int j = 0; j < 4; ++j) {
            const int source = rows.first + j;
            if (source < 0 || source >= block.height) continue;
            const float* in = block.row(source);
            const float w = rows.weights[static_cast<std::size_t>(j)];
            float* out = line.data() + kMargin * channels;
            for (std::size_t i = 0; i < block.stride(); ++i)
                out[i] += w * in[i];
        }
        for (int x = x0; x < x1; ++x) {
            const FourTaps& column = columns[static_cast<std::size_t>(x - x0)];
            const int first = column.first + static_cast<int>(kMargin);
            if (first < 0 || first + 4 > block.width + 2 * static_cast<int>(kMargin)) continue;
            const float* from = line.data() + static_cast<std::size_t>(first) * channels;
            std::array<float, 4> pixel{};
            for (std::size_t t = 0; t < 4; ++t) {
                for (std::size_t c = 0; c < channels; ++c)
                    pixel[c] += column.weights[t] * from[t * channels + c];
            }
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(into.width) + static_cast<std::size_t>(x);
            const float share = weight * (passing.values.empty() ? 1.0F : passing.values[i]);
            for (std::size_t c = 0; c < colourCount; ++c)
                into.values[i * colourCount + c] += share * pixel[c];
            if (opacity) opacity->values[i] += pixel[channels - 1];
        }
    });
}

}  // namespace ilf::view
