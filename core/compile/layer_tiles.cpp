// Which light the projector gives in each layer: the ramp on the distance to the border, carried back to the pixel.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/compile/seam.h"

namespace ilf {

namespace {

constexpr auto kPixels = static_cast<std::size_t>(kTile);

/// Nodes of a tile, interpolated along one row of pixels.
class RowOfNodes {
public:
    RowOfNodes(const Lighting& light, const Layer& layer, int column, int row, int y) {
        const float t = (static_cast<float>(y) + 0.5F) / kTile;
        const LayerNode& a = light.node(layer, column, row);
        const LayerNode& b = light.node(layer, column + 1, row);
        const LayerNode& c = light.node(layer, column, row + 1);
        const LayerNode& d = light.node(layer, column + 1, row + 1);
        from_ = mixed(a, c, t);
        to_ = mixed(b, d, t);
    }
    LayerNode at(int x) const { return mixed(from_, to_, (static_cast<float>(x) + 0.5F) / kTile); }

private:
    static Shift mixed(Shift a, Shift b, float t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }
    static LayerNode mixed(const LayerNode& a, const LayerNode& b, float t) {
        return {mixed(a.toPainted, b.toPainted, t), mixed(a.toSeen, b.toSeen, t), mixed(a.toLit, b.toLit, t),
                a.feather + t * (b.feather - a.feather), 0.0F};
    }
    LayerNode from_, to_;
};

/// A sheet around one tile.
struct SheetNear {
    Patch<std::uint8_t> weight;
    std::vector<BorderPiece> pieces;
    Patch<float> squared;  ///< distance to pieces without a step
    Patch<float> signedDistance;
};

/// The softer of ramp and brush: the ramp where the mask is harder, the brush's own slope where that is gentler.
float softer(float ramp, float weight) {
    const float own = weight / 255.0F;
    return own > 0.5F ? std::min(ramp, own) : std::max(ramp, own);
}

/// The paper's ramp over the band between a border and its magnified image, from the signed distances to both.
float bandRamp(float a, float b) {
    if (a >= 0.0F && b >= 0.0F) return 1.0F;
    if (a <= 0.0F && b <= 0.0F) return 0.0F;
    return std::max(a, b) / (std::abs(a) + std::abs(b));
}

std::uint8_t toByte(float v) { return static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F)); }

/// The largest displacement at a tile's corners, in whole pixels.
int largestShift(const Lighting& light, const Layer& layer, int column, int row) {
    float most = 0.0F;
    for (const int j : {row, row + 1}) {
        for (const int i : {column, column + 1}) {
            const LayerNode& n = light.node(layer, i, j);
            for (const Shift s : {n.toPainted, n.toSeen, n.toLit})
                most = std::max({most, std::abs(s.x), std::abs(s.y)});
        }
    }
    return static_cast<int>(std::ceil(most));
}

SheetNear sheetNear(const Visible& visible, int sheet, int column, int row) {
    const Lighting& light = visible.light;
    int shift = 0;
    for (const Layer& layer : light.layers) {
        if (layer.sheet == sheet) shift = std::max(shift, largestShift(light, layer, column, row));
    }
    const PixelRect<ProjectorFrame> tile = tileRect(column, row);
    SheetNear near;
    near.weight = gathered(visible.weights[static_cast<std::size_t>(sheet)], tile.grown(light.layerReach));
    near.pieces = borderPieces(visible, sheet, near.weight);
    const float reach = light.distanceReach;
    near.squared = Patch<float>(tile.grown(shift + 2), reach * reach);
    lowerToDistance(near.pieces, false, reach, near.squared);
    near.signedDistance = Patch<float>(near.squared.at);
    for (int y = near.squared.at.y0; y < near.squared.at.y1; ++y) {
        const std::uint8_t* weight = near.weight.row(y) + (near.squared.at.x0 - near.weight.at.x0);
        const float* squared = near.squared.row(y);
        float* to = near.signedDistance.row(y);
        for (int x = 0; x < near.squared.at.width(); ++x) {
            const float d = std::sqrt(squared[x]);
            to[x] = weight[x] > 127 ? d : -d;
        }
    }
    return near;
}

/// Pixels whose nearest border is a depth step and not too far to matter.
Tile besideSteps(const Lighting& light, const std::vector<SheetNear>& sheets, PixelRect<ProjectorFrame> tile) {
    const float reach = std::max(static_cast<float>(light.blendReach), light.distanceReach);
    Patch<float> toStep(tile, reach * reach);
    for (const SheetNear& sheet : sheets)
        lowerToDistance(sheet.pieces, true, reach, toStep);
    Tile hard;
    for (int y = 0; y < kTile; ++y) {
        for (int x = 0; x < kTile; ++x) {
            const float step = toStep(tile.x0 + x, tile.y0 + y);
            bool nearest = step < reach * reach;
            for (const SheetNear& sheet : sheets) {
                if (sheet.pieces.empty()) continue;
                const float soft = sheet.squared(tile.x0 + x, tile.y0 + y);
                nearest = nearest && (soft >= light.distanceReach * light.distanceReach || step <= soft);
            }
            hard.at(x, y) = nearest ? 255 : 0;
        }
    }
    return hard;
}

struct LitAndSeen {
    Tile lit, seen;
};

LitAndSeen blendedLayer(const Lighting& light, const Layer& layer, const SheetNear& sheet, const Tile& hard, int column,
                        int row) {
    LitAndSeen tile;
    const float full = static_cast<float>(255.0 * light.weights[static_cast<std::size_t>(layer.level)] * layer.share);
    const bool closed = light.blending == Blending::closedForm;
    const bool apart = light.blending == Blending::linearPerceived;
    for (int y = 0; y < kTile; ++y) {
        const RowOfNodes nodes(light, layer, column, row, y);
        const int py = row * kTile + y;
        const float cy = static_cast<float>(py) + 0.5F;
        for (int x = 0; x < kTile; ++x) {
            const int px = column * kTile + x;
            const float cx = static_cast<float>(px) + 0.5F;
            const auto weight = static_cast<float>(sheet.weight(px, py));
            if (hard.at(x, y) != 0) {
                tile.lit.at(x, y) = toByte(full * weight / 255.0F);
                tile.seen.at(x, y) = static_cast<std::uint8_t>(weight);
                continue;
            }
            const LayerNode node = nodes.at(x);
            if (closed) {
                const float ux = cx + node.toPainted.x, uy = cy + node.toPainted.y;
                const float distance = sheet.signedDistance.sampled(ux, uy);
                const float ramp = std::clamp(0.5F + distance / std::max(node.feather, 1e-3F), 0.0F, 1.0F);
                tile.lit.at(x, y) = toByte(full * softer(ramp, sheet.weight.sampled(ux, uy)));
                continue;
            }
            const float here = sheet.signedDistance(px, py);
            const float seen =
                softer(bandRamp(here, sheet.signedDistance.sampled(cx + node.toLit.x, cy + node.toLit.y)), weight);
            const float lit =
                apart ? softer(bandRamp(sheet.signedDistance.sampled(cx + node.toSeen.x, cy + node.toSeen.y), here),
                               weight)
                      : seen;
            tile.lit.at(x, y) = toByte(full * lit);
            tile.seen.at(x, y) = toByte(255.0F * seen);
        }
    }
    return tile;
}

/// Masks as they are: what `none` lights everywhere.
Box<Tile> asPainted(const Box<Tile>& weight, double full) {
    std::array<std::uint8_t, 256> lit;
    for (std::size_t v = 0; v < lit.size(); ++v)
        lit[v] = toByte(static_cast<float>(full * static_cast<double>(v) / 255.0));
    if (weight.same(uniformTile(weight->v[0]))) return uniformTile(lit[weight->v[0]]);
    Tile tile;
    for (std::size_t i = 0; i < kPixels * kPixels; ++i)
        tile.v[i] = lit[weight->v[i]];
    return boxed(tile);
}

}  // namespace

LayerTiles layerTiles(const Visible& visible, int column, int row) {
    const Lighting& light = visible.light;
    const PixelRect<ProjectorFrame> around = tileRect(column, row).grown(light.layerReach);
    LayerTiles tiles{{}, {}, uniformTile(0), false};
    std::vector<int> nearOf(light.sheets.size(), -1);
    std::vector<SheetNear> sheets;
    if (light.blending != Blending::none) {
        for (const Layer& layer : light.layers) {
            int& near = nearOf[static_cast<std::size_t>(layer.sheet)];
            if (near >= 0 || uniformNear(visible.weights[static_cast<std::size_t>(layer.sheet)], around)) continue;
            near = static_cast<int>(sheets.size());
            sheets.push_back(sheetNear(visible, layer.sheet, column, row));
        }
        const bool steps = std::ranges::any_of(
            sheets, [](const SheetNear& sheet) { return std::ranges::any_of(sheet.pieces, &BorderPiece::step); });
        if (steps) tiles.hard = boxed(besideSteps(light, sheets, tileRect(column, row)));
        tiles.blended = std::ranges::any_of(sheets, [](const SheetNear& sheet) { return !sheet.pieces.empty(); });
    }
    for (const Layer& layer : light.layers) {
        const Box<Tile>& weight = visible.weights[static_cast<std::size_t>(layer.sheet)].tile(column, row);
        const int near = nearOf[static_cast<std::size_t>(layer.sheet)];
        if (near < 0) {
            const double full = 255.0 * light.weights[static_cast<std::size_t>(layer.level)] * layer.share;
            tiles.lit.push_back(asPainted(weight, full));
            tiles.seen.push_back(weight);
            continue;
        }
        const LitAndSeen tile =
            blendedLayer(light, layer, sheets[static_cast<std::size_t>(near)], *tiles.hard, column, row);
        tiles.lit.push_back(boxed(tile.lit));
        tiles.seen.push_back(boxed(tile.seen));
    }
    return tiles;
}

}  // namespace ilf
