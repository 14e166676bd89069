// The loops of the engine that touch every pixel, compiled for several processors and chosen at run time.
#pragma once

#include <array>
#include <cstdint>

#include "core/perceived/engine_kernel.h"
#include "core/perceived/engine_resample.h"

namespace ilf::view {

/// Numbers that may be read or written beyond the end of a row or block by any function here.
inline constexpr int kOverrun = 32;

/// A bit for each pixel of a tile's rows.
struct TileBits {
    std::array<std::uint64_t, kTileH> lit{};      ///< above 0
    std::array<std::uint64_t, kTileH> changed{};  ///< other than before
    bool even = false;                            ///< all of the tile is one number
};
/// Takes a tile's numbers over into `kept`, and tells what they are.
TileBits keepTile(float* kept, const float* values);

/// out = unit * bytes.
void fromBytes(float* out, const std::uint8_t* bytes, int count, float unit);

/// A block that lies in a tile, or one number all over.
struct Factor {
    const float* inTile = nullptr;  ///< null: `even`
    float even = 1.0F;
};
/// out (row by row) = the product of three factors, in their order whatever they are: a number gives the same bits as a
/// block of it. Writes `width` numbers a row and none beyond.
void coverage(float* out, int outStride, int width, int rows, const std::array<Factor, 3>& factors);

/// into *= by over one tile, or into = by if `first`.
void share(float* into, const float* by, bool first);

/// into *= by, which is kept within 0 ... 1, over one tile.
void shareWithin(float* into, const float* by);

/// Numbers of one tile within `rounding` of 0 and 1 become 0 and 1.
void settle(float* tile, float rounding);

/// sums[y + 1] = sums[y] + mask[y] * values[y] for `rows` rows of `width` numbers; row 0 is set to 0. A null `mask`
/// is `even` all over, to the same bits.
void prefixSums(float* sums, int stride, int width, int rows, const float* mask, int maskStride, float even,
                const float* values, int valueStride);

/// out = mask * values, row by row. A null `mask` is `even` all over, to the same bits.
void products(float* out, int stride, int width, int rows, const float* mask, int maskStride, float even,
              const float* values, int valueStride);

/// `block` (`width` x `height`, height rounded up to 4) from the running sums of its window.
void blurBlock(float* block, int blockStride, int width, int height, const float* sums, int sumStride,
               const EdgeKernel& kernel);

/// Rows of samples spread to tile rows: out is rows x kTileW.
void resampleAcross(float* out, const float* block, int blockStride, int rows, const AcrossTaps& taps);

/// into (kTileH x kTileW) += weight * shares * (rows of `across` resampled down). A null `shares` is 1. Rows that meet
/// none of firstRow..lastRow stay; the others read rows of `across` beside those too, which must be 0.
void resampleDownAdd(float* into, const float* across, int firstRow, int lastRow, const DownTaps& taps,
                     const float* shares, float weight);

/// into += weight * shares * mask * values over one tile; null `shares` and `mask` are 1.
void addTile(float* into, const float* shares, const float* mask, int maskStride, const float* values, int valueStride,
             float weight);

/// Averages of one tile: out (kTileW / coarse x kTileH / coarse) = mask * values averaged; both start
/// averagingLead(coarse) pixels left of and above the tile. A null `mask` is `even` all over, to the same bits; null
/// `values` are 1, beside a mask. `coarse` is 2 or 4.
void averageTile(float* out, int outStride, int coarse, const float* mask, int maskStride, float even,
                 const float* values, int valueStride);

}  // namespace ilf::view
