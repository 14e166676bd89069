// The light of one slot image as it falls on the view, tile by tile, and which pixels of it changed.
#pragma once

#include <array>

#include "core/compile/program.h"
#include "core/perceived/engine_planes.h"
#include "core/registration/pixel_map.h"

namespace ilf::view {

/// Where one coordinate falls between two projector pixels.
struct BetweenPixels {
    int first = 0, second = 0;
    float part = 0.0F;
    bool inside = false;
};

/// Which projector pixels light which pixels of a view; the view's pixel (x, y) is the picture's (x / scale.x,
/// y / scale.y).
struct LightMap {
    PixelMap map;
    ViewScale scale;
    Size view, projector;
    bool upright = false;  ///< columns come from columns and rows from rows: those are worked out once
    std::vector<BetweenPixels> columns, rows;
    std::vector<std::array<float, 2>> scanned;  ///< of a dense map: where each pixel of the view lies on the raster
    std::vector<PixelRect<ProjectorFrame>> touched;  ///< of a dense map: what each tile of the view can be lit by

    LightMap(const PixelMap& map, const ViewScale& scale, Size view, Size projector);
    bool isFor(const PixelMap& other, const ViewScale& scaled, Size of, Size lit) const;
    Point<ProjectorFrame> at(int x, int y) const;
};

/// One level's image and where it lands. Bilinear between projector pixels; the outermost reach to the raster's edge,
/// beyond it is dark.
class LightRaster {
public:
    /// Takes over the image. Tells which projector pixels changed, tile by tile; all of them the first time.
    std::vector<PixelRect<ProjectorFrame>> update(const LightImage& image);
    /// 64 x 32 values 0..1 of a tile of the view.
    void sample(float* out, ViewRect tile, const LightMap& map) const;

private:
    LightImage image_;
    int width_ = 0, height_ = 0;
    std::vector<std::uint8_t> values_;
};

}  // namespace ilf::view
