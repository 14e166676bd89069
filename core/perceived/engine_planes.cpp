#include "core/perceived/engine_planes.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace ilf::view {

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

ViewRect TilePlane::set(int tile, const float* values) {
    bool same = true;
    for (int i = 1; i < kTilePixels && same; ++i)
        same = values[i] == values[0];
    Cell& cell = cells_[static_cast<std::size_t>(tile)];
    const ViewRect rect = tiles_.rect(tile);
    if (same && !cell.values) return fill(tile, values[0]);

    const bool fresh = !cell.values;
    if (fresh) cell.values = std::make_unique<float[]>(kTilePixels);
    float* kept = cell.values.get();
    if (fresh) std::fill_n(kept, kTilePixels, cell.uniform);
    ViewRect changed, above;
    for (int y = 0; y < kTileH; ++y) {
        const float* now = values + y * kTileW;
        float* before = kept + y * kTileW;
        const bool differs = std::memcmp(now, before, sizeof(float) * kTileW) != 0;
        int first = 0, last = kTileW;
        while (first < kTileW && !(now[first] > 0.0F))
            ++first;
        while (last > first && !(now[last - 1] > 0.0F))
            --last;
        if (last > first) above = above.united({rect.x0 + first, rect.y0 + y, rect.x0 + last, rect.y0 + y + 1});
        if (!differs) continue;
        first = 0;
        last = kTileW;
        while (first < kTileW && now[first] == before[first])
            ++first;
        while (last > first && now[last - 1] == before[last - 1])
            --last;
        changed = changed.united({rect.x0 + first, rect.y0 + y, rect.x0 + last, rect.y0 + y + 1});
        std::memcpy(before, now, sizeof(float) * kTileW);
    }
    // What reads a window asks for the box of all light near it: a box that grew or shrank is a change over all of it.
    if (cell.box != above) changed = changed.united(cell.box).united(above);
    cell.box = above;
    if (same) {
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

namespace {

ViewRect common(ViewRect a, ViewRect b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace

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

void product(float* out, int stride, ViewRect window, std::span<const TilePlane* const> planes) {
    const TileCount tiles = planes.front()->tiles();
    const ViewRect inside = window.clipped({tiles.columns * kTileW, tiles.rows * kTileH});
    if (inside != window) {
        for (int y = 0; y < window.height(); ++y)
            std::fill_n(out + y * stride, window.width(), 0.0F);
    }
    tiles.over(inside, [&](int tile) {
        const ViewRect part = common(inside, tiles.rect(tile));
        std::array<const float*, 3> varying{};
        std::size_t count = 0;
        float uniform = 1.0F;
        for (const TilePlane* plane : planes) {
            if (plane->values(tile)) {
                varying[count++] = plane->values(tile);
            } else {
                uniform *= plane->uniform(tile);
            }
        }
        const ViewRect rect = tiles.rect(tile);
        for (int y = part.y0; y < part.y1; ++y) {
            float* to = out + (y - window.y0) * stride + (part.x0 - window.x0);
            const int at = (y - rect.y0) * kTileW + (part.x0 - rect.x0), width = part.width();
            if (count == 0 || uniform == 0.0F) {
                std::fill_n(to, width, uniform);
                continue;
            }
            const float* a = varying[0] + at;
            if (count == 1) {
                for (int x = 0; x < width; ++x)
                    to[x] = uniform * a[x];
            } else if (count == 2) {
                const float* b = varying[1] + at;
                for (int x = 0; x < width; ++x)
                    to[x] = uniform * a[x] * b[x];
            } else {
                const float* b = varying[1] + at;
                const float* c = varying[2] + at;
                for (int x = 0; x < width; ++x)
                    to[x] = uniform * a[x] * b[x] * c[x];
            }
        }
    });
}

}  // namespace ilf::view
