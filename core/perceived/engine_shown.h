// One surface as it is shown at one power: the kernels, maps and averaged pictures that take it into the view.
#pragma once

#include <memory>
#include <vector>

#include "core/perceived/engine_floats.h"
#include "core/perceived/engine_lights.h"
#include "core/perceived/engine_simd.h"

namespace ilf::view {

/// What a rung spends.
struct RungRules {
    double blur_px = 0.12;     ///< smaller discs are no blur
    double half_px = 8.0;      ///< discs at least this large are laid over pixels averaged two by two,
    double quarter_px = 28.0;  ///< and these four by four
    /// Where blurred surfaces hide each other the pupil is cut into n x n cells, as many as make them cell_px wide in
    /// the largest such blur.
    int fewestCells = 1, mostCells = 1;
    double cell_px = 0.0;
    double spread_px = 0.45;  ///< powers whose blur differs by less are one
    double thinRim_px = 1e9;  ///< larger discs are laid over uniform pixels: a third fewer steps along their rims
    bool operator==(const RungRules&) const = default;
};
RungRules rulesOf(Rung rung);

/// Numbers over the whole view or an average of it, with zeros around, so that windows may reach over the edge.
class PaddedPlane {
public:
    static constexpr int kPad = 64;
    PaddedPlane() = default;
    PaddedPlane(int width, int height);
    float* at(int x, int y) { return values_.data() + static_cast<std::ptrdiff_t>(y + kPad) * stride_ + (x + kPad); }
    const float* at(int x, int y) const {
        return values_.data() + static_cast<std::ptrdiff_t>(y + kPad) * stride_ + (x + kPad);
    }
    int stride() const { return stride_; }
    bool empty() const { return values_.empty(); }
    /// What may be read.
    ViewRect extent() const { return {-kPad, -kPad, width_ + kPad, height_ + kPad}; }

private:
    int width_ = 0, height_ = 0, stride_ = 0;
    AlignedFloats values_;
};

/// A surface, or what one covers, blurred and placed in the view (or on another surface).
struct Shown {
    Looks looks{};
    int colours = 1;     ///< 1: all alike
    bool sharp = false;  ///< no blur
    bool still = false;  ///< and not moved either: copied
    Placing placing;
    PixelShape shape = PixelShape::tent;
    int reach = 0;  ///< of the largest kernel, samples
    /// By cell of the pupil (the whole pupil first), then colour; null: sharp.
    std::vector<std::array<std::shared_ptr<const EdgeKernel>, 3>> kernels;
    std::vector<AcrossTaps> across;  ///< by column of tiles
    std::vector<DownTaps> down;      ///< by row of tiles

    const EdgeKernel* kernel(std::size_t cell, std::size_t colour) const {
        return kernels[cell][colours == 1 ? 0 : colour].get();
    }
    /// View pixels that a change of `rect` on the surface can reach.
    ViewRect reached(ViewRect rect) const;
    /// Samples (of `placing.coarse` pixels) that a tile reads once they are blurred.
    ViewRect samples(TileCount tiles, int tile) const;
    /// View pixels that a tile depends on.
    ViewRect pixels(TileCount tiles, int tile) const;
    /// The part of `samples` that light within `lit` (view pixels) can reach.
    ViewRect litSamples(TileCount tiles, int tile, ViewRect lit) const;
};
/// Kernels are of the whole pupil; `addCells` makes those of its cells.
Shown shown(const Looks& looks, int colours, TileCount tiles, const RungRules& rules);
void addCells(Shown& shown, const std::vector<PupilCell>& cells);
/// The pupil in n x n squares, those with any part of the disc; their kernels' areas add up to 1.
std::vector<PupilCell> pupilCells(int n);

/// Room for one tile's work, kept by each thread.
struct Workspace {
    AlignedFloats mask, sums, block, across;
    alignas(AlignedFloats::kAlignment) std::array<float, kTilePixels> shares{};
    int sumStride = 0;
};
Workspace& workspace();

/// The product of planes over a window of view pixels.
struct Covered {
    ViewRect window;
    const float* mask = nullptr;  ///< row by row from the window's corner; null: all of it is `even`
    int stride = 0;
    float even = 1.0F;
};
/// Lies in `work` until the next one is made.
Covered coveredOver(Workspace& work, ViewRect window, std::span<const TilePlane* const> planes);
/// With a mask in any case.
Covered maskOver(Workspace& work, ViewRect window, std::span<const TilePlane* const> planes);

/// Asks for numbers that are read soon: they are on their way while others are worked on.
void fetchAhead(const PaddedPlane& plane, ViewRect window);

/// What is shown: a mask, numbers, or the product of both. One of them at least.
struct Source {
    Covered covered;
    const PaddedPlane* values = nullptr;
};
/// work.sums: running sums of the source over `part` (of shown.samples) grown by the look's reach. False: nothing
/// there.
bool sumSource(Workspace& work, const Shown& shown, ViewRect part, const Source& source);
/// into += weight * shares * the source of work.sums as shown. A null kernel is sharp.
void addSummed(float* into, Workspace& work, const Shown& shown, const EdgeKernel* kernel, TileCount tiles, int tile,
               ViewRect part, const float* shares, float weight);

}  // namespace ilf::view
