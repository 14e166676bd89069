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

/// A slot image as one dense array, for sampling.
class Raster {
public:
    explicit Raster(const LightImage& image)
        : width_(image.columns() * kTile), height_(image.rows() * kTile), size_(image.size()),
          values_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                const Tile& tile = *image.tile(column, row);
                for (int y = 0; y < kTile; ++y) {
                    std::copy_n(tile.v.data() + y * kTile, kTile,
                                values_.data() +
                                    static_cast<std::size_t>(row * kTile + y) * static_cast<std::size_t>(width_) +
                                    static_cast<std::size_t>(column * kTile));
                }
            }
        }
    }
    /// Bilinear, 0..1; the outermost pixels reach to the raster's edge, beyond it is dark.
    float at(double x, double y) const {
        if (!(x >= 0.0 && y >= 0.0 && x <= size_.width && y <= size_.height)) return 0.0F;
        const double u = std::clamp(x - 0.5, 0.0, size_.width - 1.0), v = std::clamp(y - 0.5, 0.0, size_.height - 1.0);
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const auto fx = static_cast<float>(u - i), fy = static_cast<float>(v - j);
        const std::uint8_t* here = values_.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(i);
        const std::size_t right = i + 1 < size_.width ? 1 : 0;
        const std::size_t below = j + 1 < size_.height ? static_cast<std::size_t>(width_) : 0;
        const float top = static_cast<float>(here[0]) * (1.0F - fx) + static_cast<float>(here[right]) * fx;
        const float bottom =
            static_cast<float>(here[below]) * (1.0F - fx) + static_cast<float>(here[below + right]) * fx;
        return (top * (1.0F - fy) + bottom * fy) / 255.0F;
    }

private:
    int width_, height_;
    Size size_;
    std::vector<std::uint8_t> values_;
};

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

std::vector<Light> lights(const Document& document, const Plan& plan, const Program& program, const ViewScale& scale,
                          PixelRect<ViewFrame> window) {
    // The levels' own images tell all: a slot that shows part of a level's light, or two levels, is a sum of them.
    std::vector<double> slots(plan.levels.size(), 0.0);
    for (const Slot& slot : plan.slots) {
        for (const LevelLight& lit : slot.lit)
            slots[static_cast<std::size_t>(lit.level)] += lit.weight;
    }
    struct Shown {
        std::size_t image;
        Dioptre power;
        double slots;
    };
    std::vector<Shown> shown;
    for (std::size_t l = 0; l < plan.levels.size() && l < program.images.size(); ++l) {
        if (slots[l] > 0.0 && !program.images[l].blank()) shown.push_back({l, plan.levels[l].power, slots[l]});
    }

    const auto toProjector = projectorFromCamera(document);
    const Size size{window.width(), window.height()};
    std::vector<Light> result;
    for (const Shown& one : shown) {
        const Raster raster(program.images[one.image]);
        std::vector<float> light(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
        parallelFor(size.height, [&](int y) {
            float* out = light.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
            for (int x = 0; x < size.width; ++x) {
                const auto at = toProjector({(window.x0 + x + 0.5) / scale.x, (window.y0 + y + 0.5) / scale.y});
                out[x] = raster.at(at.x, at.y);
            }
        });
        const double share = one.slots / static_cast<double>(plan.slots.size());
        result.push_back({Image<float>(size, 1, std::move(light)), one.power, share / plan.light});
    }
    return result;
}

}  // namespace ilf::view
