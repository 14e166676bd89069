// What each level shows: the layers, and in the base level whatever light they do not give where it is seen.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/seam.h"

namespace ilf {

namespace {

std::uint8_t rounded(double v) { return static_cast<std::uint8_t>(std::clamp(v + 0.5, 0.0, 255.0)); }

/// What one layer adds, in parts of a region's whole light, where the eye sees it.
class SeenLight {
public:
    SeenLight(const Lighting& light, const LayerGrids& layers, std::size_t index, int column, int row)
        : light_(light), layer_(light.layers[index]), lit_(layers.lit[index]), column_(column), row_(row),
          perByte_(1.0F / (255.0F * static_cast<float>(light.weights[static_cast<std::size_t>(layer_.level)]))) {
        tile_ = &*lit_.tile(column, row);
        switch (light.blending) {
        case Blending::none:
            uniform_ = uniformTileValue(lit_);
            break;
        case Blending::linearObject:
        case Blending::linearPerceived:
            seen_ = &*layers.seen[index].tile(column, row);
            uniform_ = uniformTileValue(layers.seen[index]);
            perByte_ = static_cast<float>(layer_.share) / 255.0F;
            break;
        case Blending::closedForm:
            uniform_ = uniformNear(lit_, tileRect(column, row).grown(light.blendReach));
            if (!uniform_) blur();
            break;
        }
    }

    /// The whole tile shows this much, lit and seen alike; nothing when it varies.
    std::optional<float> uniform() const {
        return uniform_ && uniformTileValue(lit_) ? std::optional(perByte_ * static_cast<float>(*uniform_))
                                                  : std::nullopt;
    }
    int level() const { return layer_.level; }
    std::uint8_t lit(int x, int y) const { return tile_->at(x, y); }
    /// Light of this pixel itself, neither moved nor blurred: what counts beside a depth step and without blending.
    float atPixel(int x, int y) const {
        return static_cast<float>(tile_->at(x, y)) /
               (255.0F * static_cast<float>(light_.weights[static_cast<std::size_t>(layer_.level)]));
    }
    float seen(int x, int y) const {
        if (uniform_) return perByte_ * static_cast<float>(*uniform_);
        if (seen_ != nullptr) return perByte_ * static_cast<float>(seen_->at(x, y));
        if (light_.blending == Blending::none) return atPixel(x, y);
        const float t = (static_cast<float>(y) + 0.5F) / kTile, u = (static_cast<float>(x) + 0.5F) / kTile;
        const auto mix = [&](float a, float b, float c, float d) {
            return (a + u * (b - a)) * (1.0F - t) + (c + u * (d - c)) * t;
        };
        const float dx = mix(back_[0].x, back_[1].x, back_[2].x, back_[3].x);
        const float dy = mix(back_[0].y, back_[1].y, back_[2].y, back_[3].y);
        return perByte_ * blurred_.sampled(static_cast<float>(column_ * kTile + x) + 0.5F + dx,
                                           static_cast<float>(row_ * kTile + y) + 0.5F + dy);
    }

private:
    std::optional<std::uint8_t> uniformTileValue(const TileGrid& grid) const {
        const Box<Tile>& tile = grid.tile(column_, row_);
        return tile.same(uniformTile(tile->v[0])) ? std::optional(tile->v[0]) : std::nullopt;
    }
    /// Filters the lit pixels with the disc as it lies on them (R / s) and only then moves the result: the same as
    /// moving first and filtering with R, without rounding in between.
    void blur() {
        float shift = 0.0F;
        std::size_t n = 0;
        for (const int j : {row_, row_ + 1}) {
            for (const int i : {column_, column_ + 1}) {
                back_[n] = light_.node(layer_, i, j).toLit;
                shift = std::max({shift, std::abs(back_[n].x), std::abs(back_[n].y)});
                ++n;
            }
        }
        const Disc& disc = light_.disc(layer_, column_, row_);
        const auto at = tileRect(column_, row_).grown(static_cast<int>(std::ceil(shift)) + 2);
        blurred_ = disc.averaged(gathered(lit_, at.grown(disc.reach())), at);
    }

    const Lighting& light_;
    const Layer& layer_;
    const TileGrid& lit_;
    int column_, row_;
    float perByte_;
    const Tile* tile_ = nullptr;
    const Tile* seen_ = nullptr;
    std::optional<std::uint8_t> uniform_;
    std::array<Shift, 4> back_{};
    Patch<float> blurred_;
};

/// One pixel of all levels.
class Mixer {
public:
    explicit Mixer(const Lighting& light) : light_(light), images_(light.weights.size()) {
        const double weakest = *std::ranges::min_element(light.weights);
        slack_ = static_cast<float>(0.51 / (255.0 * std::max(weakest, 1e-3)));
    }

    void start() { std::ranges::fill(images_, 0.0F), seen_ = 0.0F; }
    void add(int level, float lit, float seen) { images_[static_cast<std::size_t>(level)] += lit, seen_ += seen; }
    void finish() {
        const auto base = static_cast<std::size_t>(light_.base);
        // Blurs of different width overlap by more than all light here and there; all of them give way alike.
        if (seen_ > 1.0F + 2.0F * slack_) {
            for (float& image : images_)
                image /= seen_;
            return;
        }
        // What is missing by rounding alone stays missing: sharp light at one step of 255 would show on all blur.
        const float missing = 1.0F - seen_;
        if (missing > slack_) images_[base] = 255.0F * static_cast<float>(light_.weights[base]) * missing;
    }
    std::uint8_t image(std::size_t level) const { return rounded(static_cast<double>(images_[level])); }
    std::uint8_t weight(std::size_t level) const { return rounded(image(level) / light_.weights[level]); }

private:
    const Lighting& light_;
    std::vector<float> images_;
    float seen_ = 0.0F, slack_ = 0.0F;
};

}  // namespace

LevelTiles levelTiles(const Lighting& light, const LayerGrids& layers, int column, int row) {
    std::vector<SeenLight> seen;
    seen.reserve(light.layers.size());
    for (std::size_t i = 0; i < light.layers.size(); ++i)
        seen.emplace_back(light, layers, i, column, row);
    const std::size_t levels = light.weights.size();
    const Tile& hard = *layers.hard.tile(column, row);
    Mixer mixer(light);
    LevelTiles tiles;
    if (std::ranges::all_of(seen, [](const SeenLight& layer) { return layer.uniform().has_value(); })) {
        mixer.start();
        for (const SeenLight& layer : seen)
            mixer.add(layer.level(), layer.lit(0, 0), *layer.uniform());
        mixer.finish();
        for (std::size_t l = 0; l < levels; ++l) {
            tiles.images.push_back(uniformTile(mixer.image(l)));
            tiles.weights.push_back(uniformTile(mixer.weight(l)));
        }
        return tiles;
    }
    std::vector<Tile> images(levels), weights(levels);
    for (int y = 0; y < kTile; ++y) {
        for (int x = 0; x < kTile; ++x) {
            mixer.start();
            const bool asPainted = hard.at(x, y) != 0;
            for (const SeenLight& layer : seen)
                mixer.add(layer.level(), layer.lit(x, y), asPainted ? layer.atPixel(x, y) : layer.seen(x, y));
            mixer.finish();
            for (std::size_t l = 0; l < levels; ++l) {
                images[l].at(x, y) = mixer.image(l);
                weights[l].at(x, y) = mixer.weight(l);
            }
        }
    }
    for (std::size_t l = 0; l < levels; ++l) {
        tiles.images.push_back(boxed(images[l]));
        tiles.weights.push_back(boxed(weights[l]));
    }
    return tiles;
}

}  // namespace ilf
