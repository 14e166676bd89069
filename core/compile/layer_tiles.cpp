// Which light the projector gives in each layer: the ramp on the distance to the border, carried back to the pixel.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/seam.h"
#include "core/compile/shift_field.h"

namespace ilf {

namespace {

/// A sheet around the part of a tile that is worked out.
struct SheetNear {
    Patch<std::uint8_t> weight;
    std::vector<BorderPiece> pieces;
    Patch<float> signedDistance;  ///< to pieces without a step, positive inside
};

/// The softer of ramp and brush: the ramp where the mask is harder, the brush's own slope where that is gentler.
float softer(float ramp, float weight) {
    const float own = weight * (1.0F / 255.0F);
    return own > 0.5F ? std::min(ramp, own) : std::max(ramp, own);
}

/// The paper's ramp over the band between a border and its magnified image, from the signed distances to both.
float bandRamp(float a, float b) {
    if (a >= 0.0F && b >= 0.0F) return 1.0F;
    if (a <= 0.0F && b <= 0.0F) return 0.0F;
    return std::max(a, b) / (std::abs(a) + std::abs(b));
}

std::uint8_t toByte(float v) { return static_cast<std::uint8_t>(static_cast<int>(v + 0.5F)); }

float fullOf(const Layer& layer) { return static_cast<float>(255.0 * layer.share); }

float stepReach(const Lighting& light) { return std::max(static_cast<float>(light.blendReach), light.distanceReach); }

SheetNear sheetNear(const Visible& visible, int sheet, const TilePart& part) {
    const Lighting& light = visible.light;
    int shift = 0;
    for (const Layer& layer : light.layers) {
        if (layer.sheet != sheet) continue;
        for (const auto which : {&LayerNode::toPainted, &LayerNode::toSeen, &LayerNode::toLit})
            shift = std::max(shift, ShiftField(light, layer, which, part.column, part.row).reach());
    }
    SheetNear near;
    const PixelRect<ProjectorFrame> at = part.pixels.grown(shift + 2);
    bool maySteps = false;
    for (int other = 0; other < static_cast<int>(light.sheets.size()); ++other)
        maySteps = maySteps || (other != sheet && light.mayStep(sheet, other));
    const float reach = light.distanceReach;
    const int around = static_cast<int>(std::ceil(maySteps ? std::max(reach, stepReach(light)) : reach)) + 1;
    near.weight = gathered(visible.weights[static_cast<std::size_t>(sheet)], wholeSquares(at.grown(around)));
    near.pieces = borderPieces(visible, sheet, near.weight);
    near.signedDistance = Patch<float>(at, reach * reach);
    lowerToDistance(near.pieces, false, reach, near.signedDistance);
    for (int y = at.y0; y < at.y1; ++y) {
        const std::uint8_t* weight = near.weight.row(y) + (at.x0 - near.weight.at.x0);
        float* distance = near.signedDistance.row(y);
        const int width = at.width();
        for (int x = 0; x < width; ++x)
            distance[x] = std::sqrt(distance[x]) * (weight[x] > 127 ? 1.0F : -1.0F);
    }
    return near;
}

/// Pixels whose nearest border is a depth step and not too far to matter.
Tile besideSteps(const Lighting& light, const std::vector<SheetNear>& sheets, const TilePart& part,
                 const Tile& before) {
    const float reach = stepReach(light);
    const float none = 0.9999F * light.distanceReach;  // as far as distances are known: no border without a step near
    Patch<float> toStep(part.pixels, reach * reach);
    for (const SheetNear& sheet : sheets)
        lowerToDistance(sheet.pieces, true, reach, toStep);
    Tile hard = before;
    for (int y = part.pixels.y0; y < part.pixels.y1; ++y) {
        for (int x = part.pixels.x0; x < part.pixels.x1; ++x) {
            const float step = toStep(x, y);
            bool nearest = step < reach * reach;
            for (const SheetNear& sheet : sheets) {
                const float soft = std::abs(sheet.signedDistance(x, y));
                nearest = nearest && (soft >= none || step <= soft * soft);
            }
            hard.at(x % kTile, y % kTile) = nearest ? 255 : 0;
        }
    }
    return hard;
}

/// m on whole pixels of the painted picture: the ramp of the feather's width, or the brush where it is softer.
Patch<float> profile(const Lighting& light, const Layer& layer, const SheetNear& sheet, const TilePart& part) {
    const auto feather = [&](int i, int j) {
        return std::max(1e-3F, light.node(layer, part.column + i, part.row + j).feather);
    };
    const float a = feather(0, 0), b = feather(1, 0), c = feather(0, 1), d = feather(1, 1);
    Patch<float> m(sheet.signedDistance.at);
    for (int y = m.at.y0; y < m.at.y1; ++y) {
        const std::uint8_t* weight = sheet.weight.row(y) + (m.at.x0 - sheet.weight.at.x0);
        const float* distance = sheet.signedDistance.row(y);
        float* to = m.row(y);
        const float v = static_cast<float>(y - part.row * kTile) / kTile;
        const float from = a + v * (c - a), slope = (b + v * (d - b) - from) / kTile;
        const int first = m.at.x0 - part.column * kTile;
        for (int x = 0; x < m.at.width(); ++x) {
            const float width = std::max(1e-3F, from + static_cast<float>(first + x) * slope);
            const float ramp = std::min(1.0F, std::max(0.0F, 0.5F + distance[x] / width));
            const float own = static_cast<float>(weight[x]) * (1.0F / 255.0F);
            to[x] = own > 0.5F ? std::min(ramp, own) : std::max(ramp, own);
        }
    }
    return m;
}

void lightClosed(const Lighting& light, const Layer& layer, const SheetNear& sheet, const TilePart& part, Tile& lit) {
    const float full = fullOf(layer);
    const Patch<float> m = profile(light, layer, sheet, part);
    const ShiftField toPainted(light, layer, &LayerNode::toPainted, part.column, part.row);
    forEachSquare(part.pixels, [&](PixelRect<ProjectorFrame> square) {
        const std::optional<float> flat = m.flatOver(toPainted.touched(square));
        for (int y = square.y0; y < square.y1; ++y) {
            std::uint8_t* to = &lit.at(square.x0 % kTile, y % kTile);
            if (flat) {
                std::fill(to, to + kSquare, toByte(full * *flat));
                continue;
            }
            const ShiftField::Row shifts = toPainted.row(y);
            for (int x = 0; x < kSquare; ++x) {
                const Shift shift = shifts.at(square.x0 + x);
                to[x] = toByte(full * m.sampled(square.x0 + x, y, shift.x, shift.y));
            }
        }
    });
}

/// The paper's two ramps, which meet in the band between a border and its image.
void lightLinear(const Lighting& light, const Layer& layer, const SheetNear& sheet, const TilePart& part, Tile& lit,
                 Tile& seen) {
    const float full = fullOf(layer);
    const bool apparent = light.blending == Blending::linearPerceived;
    const ShiftField toSeen(light, layer, &LayerNode::toSeen, part.column, part.row);
    const ShiftField toLit(light, layer, &LayerNode::toLit, part.column, part.row);
    const auto& distance = sheet.signedDistance;
    for (int y = part.pixels.y0; y < part.pixels.y1; ++y) {
        for (int x = part.pixels.x0; x < part.pixels.x1; ++x) {
            const auto weight = static_cast<float>(sheet.weight(x, y));
            const float here = distance(x, y);
            const Shift back = toLit.at(x, y), ahead = toSeen.at(x, y);
            const float whereSeen = softer(bandRamp(here, distance.sampled(x, y, back.x, back.y)), weight);
            const float whereLit =
                apparent ? softer(bandRamp(distance.sampled(x, y, ahead.x, ahead.y), here), weight) : whereSeen;
            lit.at(x % kTile, y % kTile) = toByte(full * whereLit);
            seen.at(x % kTile, y % kTile) = toByte(255.0F * whereSeen);
        }
    }
}

/// Masks as they are: what `none` lights everywhere, and every other blending far from borders.
Box<Tile> asPainted(const Box<Tile>& weight, float full) {
    std::array<std::uint8_t, 256> lit;
    for (std::size_t v = 0; v < lit.size(); ++v)
        lit[v] = toByte(full * (static_cast<float>(v) * (1.0F / 255.0F)));
    if (weight.same(uniformTile(weight->v[0]))) return uniformTile(lit[weight->v[0]]);
    Tile tile;
    for (std::size_t i = 0; i < tile.v.size(); ++i)
        tile.v[i] = lit[weight->v[i]];
    return boxed(tile);
}

void paintHard(const Tile& hard, const Tile& weight, float full, const TilePart& part, Tile& lit, Tile& seen) {
    for (int y = part.pixels.y0; y < part.pixels.y1; ++y) {
        for (int x = part.pixels.x0; x < part.pixels.x1; ++x) {
            const int i = x % kTile, j = y % kTile;
            if (hard.at(i, j) == 0) continue;
            lit.at(i, j) = toByte(full * (static_cast<float>(weight.at(i, j)) * (1.0F / 255.0F)));
            seen.at(i, j) = weight.at(i, j);
        }
    }
}

}  // namespace

LayerTiles layerTiles(const Visible& visible, const TilePart& part, const LayerGrids& before) {
    const Lighting& light = visible.light;
    const PixelRect<ProjectorFrame> around = tileRect(part.column, part.row).grown(light.layerReach);
    LayerTiles tiles{{}, {}, uniformTile(0)};
    std::vector<int> nearOf(light.sheets.size(), -1);
    std::vector<SheetNear> sheets;
    if (light.blending != Blending::none) {
        for (const Layer& layer : light.layers) {
            int& near = nearOf[static_cast<std::size_t>(layer.sheet)];
            if (near >= 0 || uniformNear(visible.weights[static_cast<std::size_t>(layer.sheet)], around)) continue;
            near = static_cast<int>(sheets.size());
            sheets.push_back(sheetNear(visible, layer.sheet, part));
        }
        const bool steps = std::ranges::any_of(
            sheets, [](const SheetNear& sheet) { return std::ranges::any_of(sheet.pieces, &BorderPiece::step); });
        const Box<Tile>& hardBefore = before.hard.tile(part.column, part.row);
        if (steps || (!sheets.empty() && !hardBefore.same(uniformTile(0))))
            tiles.hard = boxed(besideSteps(light, sheets, part, *hardBefore));
    }
    for (std::size_t l = 0; l < light.layers.size(); ++l) {
        const Layer& layer = light.layers[l];
        const Box<Tile>& weight = visible.weights[static_cast<std::size_t>(layer.sheet)].tile(part.column, part.row);
        const int index = nearOf[static_cast<std::size_t>(layer.sheet)];
        if (index < 0) {
            tiles.lit.push_back(asPainted(weight, fullOf(layer)));
            tiles.seen.push_back(light.blending == Blending::none ? uniformTile(0) : weight);
            continue;
        }
        const SheetNear& near = sheets[static_cast<std::size_t>(index)];
        Tile lit = *before.lit[l].tile(part.column, part.row), seen = *before.seen[l].tile(part.column, part.row);
        if (light.blending == Blending::closedForm) {
            lightClosed(light, layer, near, part, lit);
        } else {
            lightLinear(light, layer, near, part, lit, seen);
        }
        if (!tiles.hard.same(uniformTile(0))) paintHard(*tiles.hard, *weight, fullOf(layer), part, lit, seen);
        tiles.lit.push_back(boxed(lit));
        tiles.seen.push_back(light.blending == Blending::closedForm ? uniformTile(0) : boxed(seen));
    }
    return tiles;
}

}  // namespace ilf
