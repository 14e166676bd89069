// Masks seen from the projector through a scanned map: which camera pixels each tile of the raster needs, and sampling.
#pragma once

#include <vector>

#include "core/base/tile_grid.h"
#include "core/compile/cover_square.h"
#include "core/compile/patch.h"
#include "core/registration/pixel_map.h"

namespace ilf {

/// What can be said of a map before any mask is known; made once for a map. How a projector pixel is averaged:
/// cover_square.h.
class DenseCoverage {
public:
    explicit DenseCoverage(const Box<DenseMap>& map);

    /// Camera pixels that a tile's samples touch; may reach beyond the picture.
    PixelRect<CameraFrame> source(int column, int row) const { return tables_[index(column, row)].source; }
    /// A tile of the mask that `patch` shows around source() clipped to the picture; at least two pixels more on each
    /// side.
    Tile tile(const MaskPatch& patch, int column, int row) const;

private:
    static constexpr int kSquares = kTile / kSquare;
    struct Table {
        PixelRect<CameraFrame> source;
        Sampling sampling;
        std::vector<PixelRect<CameraFrame>> squares;  ///< what each square touches: where that is flat, so is the tile
    };
    struct Area;
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    struct Places;
    Area areaOf(int x, int y) const;
    Places placesAround(int left, int top) const;
    Sampling samplingOver(int column, int row) const;
    Table tableOf(int column, int row) const;

    Box<DenseMap> map_;
    int columns_ = 0, rows_ = 0;
    std::vector<Table> tables_;
};

}  // namespace ilf
