// What each level shows: the layers, and in the base level whatever light they do not give where it is seen.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/seam.h"
#include "core/compile/shift_field.h"

namespace ilf {

namespace {

constexpr auto kPixels = static_cast<std::size_t>(kTile) * kTile;
using Plane = std::array<float, kPixels>;

std::size_t pixelOf(int x, int y) { return static_cast<std::size_t>((y % kTile) * kTile + x % kTile); }

std::optional<std::uint8_t> uniformValue(const Box<Tile>& tile) {
    return tile.same(uniformTile(tile->v[0])) ? std::optional(tile->v[0]) : std::nullopt;
}

/// Light per step of a level's image, in parts of a region's whole light.
constexpr float kPerStep = 1.0F / 255.0F;

/// What an eye sees of a layer all over a tile and as far around as matters, if that is the same everywhere.
std::optional<float> evenlySeen(const Lighting& light, const LayerGrids& layers, std::size_t index,
                                const TilePart& part) {
    const Layer& layer = light.layers[index];
    if (light.blending == Blending::none || light.blending == Blending::closedForm) {
        const auto even = uniformNear(layers.lit[index], tileRect(part.column, part.row).grown(light.blendReach));
        return even ? std::optional(kPerStep * static_cast<float>(*even)) : std::nullopt;
    }
    const auto even = uniformValue(layers.seen[index].tile(part.column, part.row));
    return even ? std::optional(static_cast<float>(layer.share) / 255.0F * static_cast<float>(*even)) : std::nullopt;
}

/// Adds a layer's light where it is seen: blurred by the disc as it lies on the lit pixels (R / s), then moved, which
/// equals moving first and blurring by R, without rounding in between.
void addBlurred(const Lighting& light, const LayerGrids& layers, std::size_t index, const TilePart& part, Plane& seen) {
    const Layer& layer = light.layers[index];
    const ShiftField toLit(light, layer, &LayerNode::toLit, part.column, part.row);
    const Disc& disc = light.disc(layer, part.column, part.row);
    const Patch<std::uint8_t> lit = gathered(layers.lit[index], part.pixels.grown(toLit.reach() + disc.reach() + 3));
    struct Square {
        PixelRect<ProjectorFrame> pixels;
        std::optional<std::uint8_t> flat;
    };
    std::vector<Square> squares;
    PixelRect<ProjectorFrame> varied;
    forEachSquare(part.pixels, [&](PixelRect<ProjectorFrame> square) {
        const PixelRect<ProjectorFrame> touched = toLit.touched(square);
        squares.push_back({square, lit.flatOver(touched.grown(disc.reach()))});
        if (!squares.back().flat) varied = varied.united(touched);
    });
    const Patch<float> blurred = varied.empty() ? Patch<float>() : disc.averaged(lit, varied);
    for (const Square& square : squares) {
        const PixelRect<ProjectorFrame>& at = square.pixels;
        for (int y = at.y0; y < at.y1; ++y) {
            float* to = &seen[pixelOf(at.x0, y)];
            const ShiftField::Row shifts = toLit.row(y);
            for (int x = 0; x < kSquare; ++x) {
                if (square.flat) {
                    to[x] += kPerStep * static_cast<float>(*square.flat);
                } else {
                    const Shift shift = shifts.at(at.x0 + x);
                    to[x] += kPerStep * blurred.sampled(at.x0 + x, y, shift.x, shift.y);
                }
            }
        }
    }
}

/// Calls `work(first pixel index, count)` for each row of a part. The loops inside keep their own pointers: through
/// captured arrays a byte written could be any other byte, and nothing would be done four at a time.
template <class Work>
void forEachRow(const TilePart& part, Work&& work) {
    for (int y = part.pixels.y0; y < part.pixels.y1; ++y)
        work(pixelOf(part.pixels.x0, y), part.pixels.width());
}

void fillWith(float value, const TilePart& part, Plane& plane) {
    forEachRow(part, [&](std::size_t from, int n) { std::fill_n(&plane[from], n, value); });
}

/// plane += factor * bytes.
void addBytes(const Tile& bytes, float factor, const TilePart& part, Plane& plane) {
    forEachRow(part, [&](std::size_t from, int n) {
        float* to = &plane[from];
        const std::uint8_t* v = &bytes.v[from];
        for (int x = 0; x < n; ++x)
            to[x] += factor * static_cast<float>(v[x]);
    });
}

/// Half a step of rounding, and a little.
constexpr float kSlack = 0.51F / 255.0F;

/// The base level's image where layers give `seen`. What is missing by rounding alone stays missing: sharp light at one
/// step of 255 would show on all blur.
float baseOf(float seen) {
    const float missing = 1.0F - seen;
    return missing > kSlack ? 255.0F * missing : 0.0F;
}

/// Blurs of different width overlap by more than all light here and there; all of them give way alike.
bool tooMuch(float seen) { return seen > 1.0F + 2.0F * kSlack; }

std::uint8_t toByte(float v) { return static_cast<std::uint8_t>(static_cast<int>(std::min(255.0F, v + 0.5F))); }

/// The tile when every layer is even over it and around.
std::vector<Box<Tile>> evenTiles(const Lighting& light, const LayerGrids& layers, const TilePart& part,
                                 const std::vector<std::optional<float>>& even) {
    std::vector<float> images(static_cast<std::size_t>(light.levels), 0.0F);
    float seen = 0.0F;
    for (std::size_t i = 0; i < even.size(); ++i) {
        seen += *even[i];
        images[static_cast<std::size_t>(light.layers[i].level)] +=
            static_cast<float>(layers.lit[i].tile(part.column, part.row)->v[0]);
    }
    if (tooMuch(seen)) {
        for (float& image : images)
            image /= seen;
    } else {
        images[static_cast<std::size_t>(light.base)] = baseOf(seen);
    }
    std::vector<Box<Tile>> tiles;
    for (const float image : images)
        tiles.push_back(uniformTile(toByte(image)));
    return tiles;
}

}  // namespace

std::vector<Box<Tile>> levelTiles(const Lighting& light, const LayerGrids& layers, const TilePart& part,
                                  const std::vector<TileGrid>& imagesBefore) {
    std::vector<std::optional<float>> even;
    bool allEven = true;
    for (std::size_t i = 0; i < light.layers.size(); ++i) {
        even.push_back(evenlySeen(light, layers, i, part));
        allEven = allEven && even.back() && uniformValue(layers.lit[i].tile(part.column, part.row));
    }
    if (allEven) return evenTiles(light, layers, part, even);

    // What an eye sees of all layers, pixel by pixel.
    Plane seen;
    fillWith(0.0F, part, seen);
    for (std::size_t l = 0; l < light.layers.size(); ++l) {
        const Layer& layer = light.layers[l];
        if (even[l]) {
            const float value = *even[l];
            if (value == 0.0F) continue;
            forEachRow(part, [&](std::size_t from, int n) {
                float* to = &seen[from];
                for (int x = 0; x < n; ++x)
                    to[x] += value;
            });
        } else if (light.blending == Blending::closedForm) {
            addBlurred(light, layers, l, part, seen);
        } else {
            const bool none = light.blending == Blending::none;
            addBytes(*(none ? layers.lit : layers.seen)[l].tile(part.column, part.row),
                     none ? kPerStep : static_cast<float>(layer.share) / 255.0F, part, seen);
        }
    }
    // Beside a depth step light counts where it is lit, neither moved nor blurred.
    const Box<Tile>& hard = layers.hard.tile(part.column, part.row);
    if (!hard.same(uniformTile(0))) {
        Plane lit;
        fillWith(0.0F, part, lit);
        for (std::size_t l = 0; l < light.layers.size(); ++l)
            addBytes(*layers.lit[l].tile(part.column, part.row), kPerStep, part, lit);
        forEachRow(part, [&](std::size_t from, int n) {
            for (std::size_t i = from; i < from + static_cast<std::size_t>(n); ++i)
                seen[i] = hard->v[i] != 0 ? lit[i] : seen[i];
        });
    }

    bool anyTooMuch = false;
    forEachRow(part, [&](std::size_t from, int n) {
        const float most = *std::max_element(&seen[from], &seen[from] + n);
        anyTooMuch = anyTooMuch || tooMuch(most);
    });
    std::vector<Box<Tile>> tiles;
    for (std::size_t level = 0; level < static_cast<std::size_t>(light.levels); ++level) {
        Plane image;
        fillWith(0.0F, part, image);
        for (std::size_t l = 0; l < light.layers.size(); ++l) {
            const Box<Tile>& lit = layers.lit[l].tile(part.column, part.row);
            if (light.layers[l].level == static_cast<int>(level) && !lit.same(uniformTile(0)))
                addBytes(*lit, 1.0F, part, image);
        }
        const bool isBase = static_cast<int>(level) == light.base;
        Tile tile = *imagesBefore[level].tile(part.column, part.row);
        forEachRow(part, [&](std::size_t from, int n) {
            float* v = &image[from];
            const float* s = &seen[from];
            std::uint8_t* to = &tile.v[from];
            if (isBase) {
                for (int x = 0; x < n; ++x)
                    v[x] = baseOf(s[x]);
            } else if (anyTooMuch) {
                for (int x = 0; x < n; ++x)
                    v[x] = tooMuch(s[x]) ? v[x] / s[x] : v[x];
            }
            for (int x = 0; x < n; ++x)
                to[x] = toByte(v[x]);
        });
        tiles.push_back(boxed(tile));
    }
    return tiles;
}

}  // namespace ilf
