#include "core/perceived/surfaces.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/srgb.h"

namespace ilf::view {
namespace {

/// Source pixels under one target pixel along one axis, by overlap.
struct Overlap {
    int first = 0;
    std::vector<float> weights;
};

std::vector<Overlap> overlaps(int from, int to) {
    std::vector<Overlap> result;
    const double ratio = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double begin = i * ratio, end = (i + 1) * ratio;
        Overlap overlap{static_cast<int>(std::floor(begin)), {}};
        for (int s = overlap.first; s < std::min(from, static_cast<int>(std::ceil(end - 1e-9))); ++s) {
            const double part = std::min(end, s + 1.0) - std::max(begin, static_cast<double>(s));
            overlap.weights.push_back(static_cast<float>(part / ratio));
        }
        result.push_back(std::move(overlap));
    }
    return result;
}

}  // namespace

ViewScale viewScale(const Document& document, double scale) {
    const Size full = document.scene.size();
    const Size size{std::max(1, static_cast<int>(std::lround(full.width * scale))),
                    std::max(1, static_cast<int>(std::lround(full.height * scale)))};
    return {size, scale, static_cast<double>(size.width) / std::max(1, full.width),
            static_cast<double>(size.height) / std::max(1, full.height)};
}

Image<float> shrunk(const Image<float>& image, Size size) {
    if (size == image.size()) return image;
    const auto across = overlaps(image.width(), size.width), down = overlaps(image.height(), size.height);
    const auto channels = static_cast<std::size_t>(image.channels());
    const std::size_t stride = static_cast<std::size_t>(size.width) * channels;
    std::vector<float> pixels(stride * static_cast<std::size_t>(size.height));
    parallelFor(size.height, [&](int y) {
        std::vector<float> sum(image.stride());
        const Overlap& rows = down[static_cast<std::size_t>(y)];
        for (std::size_t r = 0; r < rows.weights.size(); ++r) {
            const float* row = image.row(rows.first + static_cast<int>(r));
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += rows.weights[r] * row[i];
        }
        float* out = pixels.data() + stride * static_cast<std::size_t>(y);
        for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x) {
            for (std::size_t c = 0; c < channels; ++c) {
                const float* from = sum.data() + static_cast<std::size_t>(across[x].first) * channels + c;
                float value = 0.0F;
                for (std::size_t s = 0; s < across[x].weights.size(); ++s)
                    value += across[x].weights[s] * from[s * channels];
                out[x * channels + c] = value;
            }
        }
    });
    return Image<float>(size, image.channels(), std::move(pixels));
}

Radiance albedo(const Document& document, const ViewScale& scale) {
    return shrunk(toLinear(*document.scene.picture), scale.size);
}

std::vector<Surface> surfaces(const std::vector<SceneLayer>& layers, PixelRect<ViewFrame> window) {
    // Less than this is left of a pixel only by rounding.
    constexpr float kNothing = 1.0F / 512.0F;
    const Size size{window.width(), window.height()};
    const auto width = static_cast<std::size_t>(size.width);
    const std::size_t count = width * static_cast<std::size_t>(size.height);
    std::vector<float> left(count, 1.0F);
    std::vector<Surface> result;
    for (const SceneLayer& layer : layers) {
        std::vector<float> alpha(count);
        std::vector<PixelRect<ViewFrame>> covered(static_cast<std::size_t>(size.height));
        parallelFor(size.height, [&](int y) {
            const float* share = layer.coverage.row(window.y0 + y) + window.x0;
            const std::size_t at = static_cast<std::size_t>(y) * width;
            for (std::size_t x = 0; x < width; ++x) {
                float& rest = left[at + x];
                if (share[x] <= 0.0F || rest <= kNothing) continue;
                alpha[at + x] = std::min(1.0F, share[x] / rest);
                rest -= share[x];
                const int i = static_cast<int>(x);
                auto& row = covered[static_cast<std::size_t>(y)];
                row = row.united({i, y, i + 1, y + 1});
            }
        });
        PixelRect<ViewFrame> box;
        for (const auto& row : covered)
            box = box.united(row);
        if (!box.empty())
            result.push_back({layer.distance, Image<float>(size, 1, std::move(alpha)), box, layer.region});
    }
    return result;
}

}  // namespace ilf::view
