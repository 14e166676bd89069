// The marks that show regions on the picture: an edge line and a hatch for each look, as pixels.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/document/document.h"

namespace ilf::ui {

/// RGBA, 8 bits, not premultiplied, row-major: what a GL texture takes.
using OverlayTile = std::array<std::uint8_t, static_cast<std::size_t>(kTile) * kTile * 4>;

/// All that the overlay depends on: a document and which region is drawn brighter.
struct OverlaySubject {
    Document document;
    RegionId selected;
};

/// Marks of the tile at (column, row) of the masks' grid. Focus: blue, dotted edge. Blur: orange, diagonal hatch.
/// Neutral: grey edge. The topmost active region that covers a pixel owns it; locked ones look the same, hidden ones do
/// not show. Widths grow with the picture, so that marks stay visible when it is fitted into the canvas.
OverlayTile overlayTile(const Document& document, const RegionId& selected, int column, int row);

/// Tiles (column, row) whose overlay can differ between two subjects; all of them when the pictures' sizes differ.
std::vector<std::pair<int, int>> overlayTilesThatDiffer(const OverlaySubject& before, const OverlaySubject& after);

}  // namespace ilf::ui
