// Masks seen from the projector through a scanned map: which camera pixels each tile of the raster needs, and sampling.
#pragma once

#include <vector>

#include "core/base/tile_grid.h"
#include "core/compile/patch.h"
#include "core/registration/pixel_map.h"

namespace ilf {

/// What can be said of a map before any mask is known; made once for a map.
///
/// A projector pixel that covers several camera pixels is averaged over n x n points of its area, and interpolated
/// between camera pixels otherwise. Its area is spanned by how the map goes on beside it, on the smoother side: across
/// a depth step it stays on its own surface.
class DenseCoverage {
public:
    explicit DenseCoverage(const Box<DenseMap>& map);

    /// Camera pixels that a tile's samples touch; may reach beyond the picture.
    PixelRect<CameraFrame> source(int column, int row) const { return tables_[index(column, row)].source; }
    /// A tile of the mask whose pixels `pixels` shows around source() clipped to the picture; at least two pixels more
    /// on each side, 0 outside the picture.
    Tile tile(const std::vector<std::uint8_t>& pixels, PixelRect<CameraFrame> at, int column, int row) const;

private:
    static constexpr int kSquares = kTile / kSquare;
    struct Table {
        PixelRect<CameraFrame> source;
        int samples = 1;                              ///< n
        std::vector<PixelRect<CameraFrame>> squares;  ///< what each square touches: where that is flat, so is the tile
    };
    struct Area;
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    Area areaOf(int x, int y) const;
    int samplesOver(int column, int row) const;
    Table tableOf(int column, int row) const;

    Box<DenseMap> map_;
    int columns_ = 0, rows_ = 0;
    std::vector<Table> tables_;
};

}  // namespace ilf
