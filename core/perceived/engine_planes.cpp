#include "core/perceived/engine_planes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/base/parallel.h"
#include "core/perceived/engine_simd.h"

namespace ilf::view {

void shareOut(int count, int threads, const std::function<void(int)>& work) {
    // Runs of neighbours: what they read lies close together, and each thread keeps its own near.
    const int run = threads > 1 && count > 2 ? std::clamp(count / 16, 1, 16) : count;
    const auto doRun = [&](int n) {
        for (int i = n * run; i < std::min(count, (n + 1) * run); ++i)
            work(i);
    };
    if (run == count) {
        doRun(0);
    } else {
        parallelFor((count + run - 1) / run, doRun);
    }
}

TileCount tileCount(Size size) { return {(size.width + kTileW - 1) / kTileW, (size.height + kTileH - 1) / kTileH}; }

ViewRect TilePlane::fill(int tile, float value) {
    Cell& cell = cells_[static_cast<std::size_t>(tile)];
    const ViewRect rect = tiles_.rect(tile);
    ViewRect changed;
    if (cell.values || cell.uniform != value) changed = rect;
    cell.values.reset();
    cell.uniform = value;
    cell.box = value > 0.0F ? rect : ViewRect{};
    return changed;
}

namespace {

/// A box around the bits of a tile.
ViewRect boxOf(const std::array<std::uint64_t, kTileH>& rows, ViewRect tile) {
    std::uint64_t columns = 0;
    int first = kTileH, last = 0;
    for (int y = 0; y < kTileH; ++y) {
        const std::uint64_t row = rows[static_cast<std::size_t>(y)];
        if (row == 0) continue;
        columns |= row;
        first = std::min(first, y);
        last = y + 1;
    }
    if (columns == 0) return {};
    return {tile.x0 + std::countr_zero(columns), tile.y0 + first, tile.x0 + kTileW - std::countl_zero(columns),
            tile.y0 + last};
}

ViewRect common(ViewRect a, ViewRect b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace

ViewRect TilePlane::set(int tile, const float* values) {
    static_assert(kTileW == 64, "a row of a tile is one word of bits");
    Cell& cell = cells_[static_cast<std::size_t>(tile)];
    const ViewRect rect = tiles_.rect(tile);
    if (!cell.values) {
        const bool even = std::memcmp(values, values + 1, sizeof(float) * (kTilePixels - 1)) == 0;
        if (even) return fill(tile, values[0]);
        cell.values = std::make_unique<AlignedFloats>(kTilePixels);
        std::fill_n(cell.values->data(), kTilePixels, cell.uniform);
    }
    const TileBits bits = keepTile(cell.values->data(), values);
    ViewRect changed = boxOf(bits.changed, rect);
    const ViewRect above = boxOf(bits.lit, rect);
    // What reads a window asks for the box of all light near it: a box that grew or shrank is a change over all of it.
    if (cell.box != above) changed = changed.united(cell.box).united(above);
    cell.box = above;
    if (bits.even) {
        cell.values.reset();
        cell.uniform = values[0];
    }
    return changed;
}

bool TilePlane::uniformOver(ViewRect window, float value) const {
    const ViewRect inside = window.clipped({tiles_.columns * kTileW, tiles_.rows * kTileH});
    if (value != 0.0F && inside != window) return false;
    bool all = true;
    tiles_.over(inside, [&](int tile) {
        if (!all) return;
        if (value == 0.0F) {
            const ViewRect box = at(tile).box;
            all =
                box.x1 <= window.x0 || box.x0 >= window.x1 || box.y1 <= window.y0 || box.y0 >= window.y1 || box.empty();
        } else {
            all = isUniform(tile, value);
        }
    });
    return all;
}

ViewRect litBox(ViewRect window, std::span<const TilePlane* const> planes) {
    ViewRect lit;
    planes.front()->tiles().over(window, [&](int tile) {
        ViewRect box = window;
        for (const TilePlane* plane : planes) {
            box = common(box, plane->box(tile));
            if (box.empty()) return;
        }
        lit = lit.united(box);
    });
    return lit;
}

std::optional<float> evenOver(ViewRect window, std::span<const TilePlane* const> planes) {
    const TileCount tiles = planes.front()->tiles();
    if (window.empty() || window.clipped({tiles.columns * kTileW, tiles.rows * kTileH}) != window) return {};
    std::optional<float> even;
    bool all = true;
    tiles.over(window, [&](int tile) {
        if (!all) return;
        float product = 1.0F;
        for (const TilePlane* plane : planes) {
            if (plane->values(tile)) {
                all = false;
                return;
            }
            product *= plane->uniform(tile);
        }
        all = !even || *even == product;
        even = product;
    });
    return all ? even : std::nullopt;
}

void product(float* out, int stride, ViewRect window, std::span<const TilePlane* const> planes) {
    const TileCount tiles = planes.front()->tiles();
    const ViewRect inside = window.clipped({tiles.columns * kTileW, tiles.rows * kTileH});
    if (inside != window) {
        for (int y = 0; y < window.height(); ++y)
            std::fill_n(out + y * stride, window.width(), 0.0F);
    }
    tiles.over(inside, [&](int tile) {
        const ViewRect rect = tiles.rect(tile), part = common(inside, rect);
        std::array<Factor, 3> factors;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const float* values = planes[i]->values(tile);
            factors[i] = {values ? values + (part.y0 - rect.y0) * kTileW + (part.x0 - rect.x0) : nullptr,
                          planes[i]->uniform(tile)};
        }
        coverage(out + (part.y0 - window.y0) * stride + (part.x0 - window.x0), stride, part.width(), part.height(),
                 factors);
    });
}

}  // namespace ilf::view
