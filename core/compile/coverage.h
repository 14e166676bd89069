// Masks seen from the projector: how much of each projector pixel a region covers.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/tile_grid.h"
#include "core/compile/dense_coverage.h"

namespace ilf {

/// Samples camera-frame masks on projector pixels. A projector pixel smaller than a camera pixel is interpolated
/// (bilinear); a larger one is averaged over its area, so that a mask thinner than a projector pixel dims it instead of
/// flickering in and out. Outside the picture coverage is 0: what no region covers is background.
class CoverageSampler {
public:
    CoverageSampler(Size picture, Size projector, const Homography<ProjectorFrame, CameraFrame>& projectorFromCamera);
    /// Precondition: a dense map has the sizes of picture and raster.
    CoverageSampler(Size picture, Size projector, const PixelMap& map);
    /// Whether it was made from this very map, for these sizes.
    bool isFor(Size picture, Size projector, const PixelMap& map) const;

    /// One projector tile of `mask`. The result depends on nothing but the mask's values near it.
    Box<Tile> tile(const Mask& mask, int column, int row) const;

    /// Camera pixels that can reach this projector tile.
    PixelRect<CameraFrame> source(int column, int row) const;

private:
    /// For each projector pixel along one axis: the first camera pixel it reaches, and `count` weights (sum 256) from
    /// there on, the last ones 0 where fewer would do.
    struct Taps {
        int count = 0;
        std::vector<int> first;
        std::vector<std::uint16_t> weights;
    };
    static Taps taps(int pixels, double scale, double offset);
    Tile separable(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column, int row) const;
    Tile projected(const MaskPatch& patch, int column, int row) const;

    Size picture_, projector_;
    PixelMap map_;
    std::shared_ptr<const DenseCoverage> dense_;  ///< or none: the map is a homography
    Homography<CameraFrame, ProjectorFrame> cameraFromProjector_;
    bool axisAligned_ = false;  ///< scale and shift only: rows and columns are filtered one after the other
    bool identity_ = false;     ///< same pixels: tiles are shared instead of sampled
    Taps across_, down_;
};

}  // namespace ilf
