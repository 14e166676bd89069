// A perceived view as a texture takes it: 8-bit tiles, shared with the view before where nothing changed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/box.h"
#include "core/perceived/view_engine.h"

namespace ilf::app {

/// RGBA, sRGB-encoded, row by row; at the right and lower edge of the view it reaches beyond.
using ScreenTile = std::array<std::uint8_t, static_cast<std::size_t>(ViewTile::kWidth) * ViewTile::kHeight * 4>;

struct ScreenView {
    Size size;
    int columns = 0, rows = 0;
    std::vector<Box<ScreenTile>> tiles;  ///< row by row, as PerceivedView::tiles
};

/// `seen` for the screen. Of a view before, `before` is what was seen and `shown` what this function gave for it: a
/// tile that is the same as then, or differs by less than the screen can show, stays the same box and is not sent
/// again.
ScreenView screenView(const PerceivedView& seen, const PerceivedView& before, const ScreenView& shown);
ScreenView screenView(const PerceivedView& seen);

/// Tiles of `view` that hold the same codes as those of `other` become the same boxes.
void shareEqual(ScreenView& view, const ScreenView& other);

}  // namespace ilf::app
