#include "core/perceived/disc_blur.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/perceived/engine_kernel.h"

namespace ilf::view {
namespace {

/// Lines across a pixel's tent over which chords are averaged: the weights are right to 1e-4.
constexpr int kLines = 64;
constexpr int kRowsAtOnce = 16;

struct Tap {
    std::ptrdiff_t at;  ///< in pixels from the output pixel, into running sums
    float weight;
};

/// Tents of the pixels of one kernel row inside the disc, `dy` pixels from the centre, with a 0 at both ends.
std::vector<double> rowWeights(double radius, int reach, int dy) {
    std::vector<double> weights(static_cast<std::size_t>(2 * reach + 3), 0.0);
    for (int line = 0; line < kLines; ++line) {
        const double offset = -1.0 + 2.0 * (line + 0.5) / kLines;
        const double y = dy + offset;
        const double square = radius * radius - y * y;
        if (square <= 0.0) continue;
        const double half = std::sqrt(square), part = (1.0 - std::abs(offset)) * 2.0 / kLines;
        for (int dx = -reach; dx <= reach; ++dx) {
            weights[static_cast<std::size_t>(dx + reach + 1)] += part * (tentUpTo(half - dx) - tentUpTo(-half - dx));
        }
    }
    return weights;
}

/// The steps of one kernel row.
std::vector<Tap> rowTaps(const std::vector<double>& weights, int reach, double area) {
    std::vector<Tap> taps;
    for (int m = -reach; m <= reach + 1; ++m) {
        const auto i = static_cast<std::size_t>(m + reach + 1);
        const double step = (weights[i - 1] - weights[i]) / area;
        if (step != 0.0) taps.push_back({m, static_cast<float>(step)});
    }
    return taps;
}

/// out[i] += sum of weight * sums[i + at].
void addTaps(float* __restrict out, const float* __restrict sums, std::size_t count, const std::vector<Tap>& taps,
             int channels) {
    std::size_t t = 0;
    for (; t + 4 <= taps.size(); t += 4) {
        const float* __restrict a = sums + taps[t].at * channels;
        const float* __restrict b = sums + taps[t + 1].at * channels;
        const float* __restrict c = sums + taps[t + 2].at * channels;
        const float* __restrict d = sums + taps[t + 3].at * channels;
        const float wa = taps[t].weight, wb = taps[t + 1].weight, wc = taps[t + 2].weight, wd = taps[t + 3].weight;
        for (std::size_t i = 0; i < count; ++i)
            out[i] += (wa * a[i] + wb * b[i]) + (wc * c[i] + wd * d[i]);
    }
    for (; t < taps.size(); ++t) {
        const float* __restrict a = sums + taps[t].at * channels;
        const float wa = taps[t].weight;
        for (std::size_t i = 0; i < count; ++i)
            out[i] += wa * a[i];
    }
}

}  // namespace

int discReach(double radius) { return static_cast<int>(std::ceil(radius + 1.0)); }

Block discBlurred(const Block& block, double radius) {
    const int reach = discReach(radius), channels = block.channels;
    Block blurred(block.width + 2 * reach, block.height + 2 * reach, channels);

    // Running sums of each row, with room for every tap of every output pixel on both sides.
    const int margin = 2 * reach + 1;
    Block sums(block.width + 2 * margin, block.height, channels);
    parallelFor(block.height, [&](int y) {
        const float* in = block.row(y);
        float* sum = sums.row(y);
        const auto from = static_cast<std::size_t>((margin + 1) * channels);
        for (std::size_t i = 0; i < block.stride(); ++i) {
            sum[from + i] = sum[from + i - static_cast<std::size_t>(channels)] + in[i];
        }
        for (std::size_t i = from + block.stride(); i < sums.stride(); ++i) {
            sum[i] = sum[i - static_cast<std::size_t>(channels)];
        }
    });

    std::vector<std::vector<double>> weights;
    double area = 0.0;  // as the weights have it, so that no light is lost
    for (int dy = -reach; dy <= reach; ++dy) {
        weights.push_back(rowWeights(radius, reach, dy));
        area = std::accumulate(weights.back().begin(), weights.back().end(), area);
    }
    std::vector<std::vector<Tap>> kernel;
    for (const auto& row : weights)
        kernel.push_back(rowTaps(row, reach, area));
    const int chunks = (blurred.height + kRowsAtOnce - 1) / kRowsAtOnce;
    parallelFor(chunks, [&](int chunk) {
        for (int y = chunk * kRowsAtOnce; y < std::min((chunk + 1) * kRowsAtOnce, blurred.height); ++y) {
            const int centre = y - reach;
            for (int dy = std::max(-reach, -centre); dy <= std::min(reach, block.height - 1 - centre); ++dy) {
                // Pixel x of the output lies at x - reach of the block, that is x + reach + 1 of the sums.
                const float* row = sums.row(centre + dy) + (reach + 1) * channels;
                addTaps(blurred.row(y), row, blurred.stride(), kernel[static_cast<std::size_t>(dy + reach)], channels);
            }
        }
    });
    return blurred;
}

}  // namespace ilf::view
