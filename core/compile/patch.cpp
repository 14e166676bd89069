#include "core/compile/patch.h"

namespace ilf {

Patch<std::uint8_t> gathered(const TileGrid& grid, PixelRect<ProjectorFrame> rect) {
    Patch<std::uint8_t> patch;
    patch.at = rect;
    patch.v = gatheredOrZero(grid, rect);
    const PixelRect<ProjectorFrame> inside = rect.clipped(grid.size());
    if (inside == rect || inside.empty()) return patch;
    for (int y = inside.y0; y < inside.y1; ++y) {
        std::uint8_t* line = patch.row(y);
        std::fill(line, line + (inside.x0 - rect.x0), line[inside.x0 - rect.x0]);
        std::fill(line + (inside.x1 - rect.x0), line + rect.width(), line[inside.x1 - 1 - rect.x0]);
    }
    const auto bytes = static_cast<std::size_t>(rect.width());
    for (int y = rect.y0; y < inside.y0; ++y)
        std::memcpy(patch.row(y), patch.row(inside.y0), bytes);
    for (int y = inside.y1; y < rect.y1; ++y)
        std::memcpy(patch.row(y), patch.row(inside.y1 - 1), bytes);
    return patch;
}

}  // namespace ilf
