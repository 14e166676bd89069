#include "core/perceived/engine_shown.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ilf::view {
namespace {

/// Discs smaller than this round the corners of what is bilinear between pixels, which interpolation can do.
constexpr double kSoft = 0.6;
/// Colours whose discs differ by less are blurred alike there.
constexpr double kSameColour = 0.1;
/// Magnification that moves nothing by more than this many pixels is none.
constexpr double kNoShift = 0.02;

std::shared_ptr<const EdgeKernel> kernelOf(double radius_px, const Shown& shown, const PupilCell& cell) {
    // Exactly in focus beside colours that are not.
    double radius = std::abs(radius_px) < 1e-6 ? std::copysign(1e-6, radius_px) : radius_px / shown.placing.coarse;
    // A uniform pixel spreads light less than one that is bilinear to its neighbours (1/12 and 1/6 of a pixel squared
    // along each axis), a disc by a quarter of its radius squared: the wider disc makes up for it.
    if (shown.shape == PixelShape::box && shown.placing.coarse == 1)
        radius = std::copysign(std::sqrt(radius * radius + 1.0 / 3.0), radius);
    return std::make_shared<const EdgeKernel>(edgeKernel(radius, cell, shown.shape));
}

int padded(int numbers) { return (numbers + 15) / 16 * 16 + kOverrun; }

}  // namespace

RungRules rulesOf(Rung rung) {
    switch (rung) {
    case Rung::dragging:
        return {0.3, 5.0, 16.0, 1, 1, 0.0, 0.7, 1.5};
    case Rung::rest:
        return {0.12, 6.0, 24.0, 2, 4, 6.5, 0.5};
    case Rung::idle:
        return {0.05, 14.0, 36.0, 4, 6, 4.0, 0.2};
    }
    return {};
}

PaddedPlane::PaddedPlane(int width, int height)
    : width_(width), height_(height), stride_(width + 2 * kPad),
      values_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2 * kPad) + kOverrun) {}

ViewRect Shown::reached(ViewRect rect) const {
    if (rect.empty()) return rect;
    const double s = placing.magnification;
    // Averages reach three pixels beyond their own, kernels their reach, and interpolation two samples.
    const double c = placing.coarse;
    const double grown = sharp ? 3.0 : s * (c * (reach + 2.5) + (placing.coarse == 1 ? 0.0 : 3.0)) + 1.0;
    const auto lower = [&](double at, double centre) {
        return static_cast<int>(std::floor(centre + s * (at - centre) - grown));
    };
    const auto upper = [&](double at, double centre) {
        return static_cast<int>(std::ceil(centre + s * (at - centre) + grown));
    };
    return {lower(rect.x0, placing.centreX), lower(rect.y0, placing.centreY), upper(rect.x1, placing.centreX),
            upper(rect.y1, placing.centreY)};
}

ViewRect Shown::samples(TileCount tiles, int tile) const {
    if (still) return tiles.rect(tile);
    const AcrossTaps& x = across[static_cast<std::size_t>(tile % tiles.columns)];
    const DownTaps& y = down[static_cast<std::size_t>(tile / tiles.columns)];
    return {x.first, y.first, x.first + x.width, y.first + y.height};
}

ViewRect Shown::pixels(TileCount tiles, int tile) const {
    const ViewRect window = samples(tiles, tile).grown(reach);
    const int c = placing.coarse, lead = averagingLead(c);
    return {window.x0 * c - lead, window.y0 * c - lead, window.x1 * c + lead, window.y1 * c + lead};
}

ViewRect Shown::litSamples(TileCount tiles, int tile, ViewRect lit) const {
    const ViewRect all = samples(tiles, tile);
    const int c = placing.coarse, lead = averagingLead(c);
    const auto below = [&](int v) { return (v >= 0 ? v / c : -((c - 1 - v) / c)) - reach; };
    const auto above = [&](int v) { return below(v + c - 1) + 2 * reach; };
    // In whole fours of rows from the top: the blur sums a row in an order that depends on its place among the four.
    const int top = std::max(all.y0, below(lit.y0 - lead));
    return {std::max(all.x0, below(lit.x0 - lead)), top - (top - all.y0) % 4, std::min(all.x1, above(lit.x1 + lead)),
            std::min(all.y1, above(lit.y1 + lead))};
}

Shown shown(const Looks& looks, int colours, TileCount tiles, const RungRules& rules) {
    Shown made;
    made.looks = looks;
    made.colours = colours;
    double least = 1e9, most = 0.0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(colours); ++c) {
        const double radius = std::abs(looks[colours == 1 ? 1 : c].radius);
        least = std::min(least, radius);
        most = std::max(most, radius);
    }
    const Appearance& look = looks[1];
    const double far = std::max(
        {look.centreX, look.centreY, tiles.columns * kTileW - look.centreX, tiles.rows * kTileH - look.centreY});
    made.still = most < rules.blur_px && std::abs(look.magnification - 1.0) * far < kNoShift;
    made.sharp = made.still || (most < kSoft && most - least < kSameColour);
    const int coarse = least >= rules.quarter_px ? 4 : least >= rules.half_px ? 2 : 1;
    made.placing = {coarse,
                    look.magnification,
                    look.centreX,
                    look.centreY,
                    made.sharp ? Interpolation::linear : Interpolation::smooth,
                    made.sharp ? most : 0.0};
    made.shape = coarse != 1 || least >= rules.thinRim_px ? PixelShape::box : PixelShape::tent;
    if (made.sharp) {
        made.kernels.emplace_back();
    } else {
        addCells(made, {PupilCell{}});
    }
    if (made.still) return made;
    for (int column = 0; column < tiles.columns; ++column)
        made.across.push_back(acrossTaps(made.placing, column));
    for (int row = 0; row < tiles.rows; ++row)
        made.down.push_back(downTaps(made.placing, row));
    return made;
}

void addCells(Shown& shown, const std::vector<PupilCell>& cells) {
    for (const PupilCell& cell : cells) {
        auto& kernels = shown.kernels.emplace_back();
        for (std::size_t c = 0; c < static_cast<std::size_t>(shown.colours); ++c) {
            kernels[c] = kernelOf(shown.looks[shown.colours == 1 ? 1 : c].radius, shown, cell);
            if (kernels[c]) shown.reach = std::max(shown.reach, kernels[c]->reach);
        }
    }
}

std::vector<PupilCell> pupilCells(int n) {
    std::vector<PupilCell> cells;
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            const auto edge = [&](int i) { return -1.0 + 2.0 * i / n; };
            const PupilCell cell{edge(column), edge(row), edge(column + 1), edge(row + 1)};
            const double nearX = cell.x0 > 0.0 ? cell.x0 : std::min(0.0, cell.x1);
            const double nearY = cell.y0 > 0.0 ? cell.y0 : std::min(0.0, cell.y1);
            if (nearX * nearX + nearY * nearY < 0.999) cells.push_back(cell);
        }
    }
    return cells;
}

Workspace& workspace() {
    thread_local Workspace work;
    return work;
}

void fetchAhead(const PaddedPlane& plane, ViewRect window) {
    constexpr int kLine = 16;  // numbers fetched together
    for (int y = window.y0; y < window.y1; ++y) {
        const float* row = plane.at(window.x0, y);
        for (int x = 0; x < window.width(); x += kLine)
            __builtin_prefetch(row + x, 0, 2);
    }
}

Covered coveredOver(Workspace& work, ViewRect window, std::span<const TilePlane* const> planes) {
    if (const auto even = evenOver(window, planes)) return {window, nullptr, 0, *even};
    return maskOver(work, window, planes);
}

Covered maskOver(Workspace& work, ViewRect window, std::span<const TilePlane* const> planes) {
    const int stride = padded(window.width());
    work.mask.need(static_cast<std::size_t>(stride) * static_cast<std::size_t>(window.height() + 4) + kOverrun);
    product(work.mask.data(), stride, window, planes);
    return {window, work.mask.data(), stride, 1.0F};
}

bool sumSource(Workspace& work, const Shown& shown, ViewRect part, const Source& source) {
    const ViewRect own = part.grown(shown.reach);
    const int stride = padded(own.width()), rows = own.height();
    work.sumStride = stride;
    work.sums.need(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows + 8) + kOverrun);
    const ViewRect extent = source.values ? source.values->extent() : own;
    const ViewRect readable{std::max(own.x0, extent.x0), std::max(own.y0, extent.y0), std::min(own.x1, extent.x1),
                            std::min(own.y1, extent.y1)};
    if (readable.empty()) return false;
    const Covered& covered = source.covered;
    const float* mask = covered.mask ? covered.mask + (readable.y0 - covered.window.y0) * covered.stride + readable.x0 -
                                           covered.window.x0
                                     : nullptr;
    const float* values = source.values ? source.values->at(readable.x0, readable.y0) : mask;
    const int valueStride = source.values ? source.values->stride() : covered.stride;
    if (!source.values) mask = nullptr;
    const float even = source.values ? covered.even : 1.0F;
    float* sums = work.sums.data();
    if (readable != own) std::fill_n(sums, stride * (rows + 8), 0.0F);
    float* from = sums + (readable.y0 - own.y0) * stride + (readable.x0 - own.x0);
    if (shown.sharp) {  // no sums: the products themselves, row by row
        products(from, stride, readable.width(), readable.height(), mask, covered.stride, even, values, valueStride);
        return true;
    }
    prefixSums(from, stride, readable.width(), readable.height(), mask, covered.stride, even, values, valueStride);
    // Rows below what can be read repeat the last sums. (Rows that only fill up the last four are for nothing.)
    const int last = readable.y1 - own.y0;
    for (int y = last + 1; y <= rows; ++y)
        std::memcpy(sums + y * stride, sums + last * stride, sizeof(float) * static_cast<std::size_t>(stride));
    return true;
}

void addSummed(float* into, Workspace& work, const Shown& shown, const EdgeKernel* kernel, TileCount tiles, int tile,
               ViewRect part, const float* shares, float weight) {
    const AcrossTaps& across = shown.across[static_cast<std::size_t>(tile % tiles.columns)];
    const DownTaps& down = shown.down[static_cast<std::size_t>(tile / tiles.columns)];
    // Samples of the tile, of which `part` is not 0. The blur writes whole fours of rows and whole vectors: what is
    // left of former tiles beside a row, up to a vector to its left, meets weights of 0.
    const int stride = padded(across.width + AcrossTaps::kLanes);
    work.block.need(static_cast<std::size_t>(stride) * static_cast<std::size_t>(down.height + 8) + kOverrun +
                    AcrossTaps::kLanes);
    work.across.need(static_cast<std::size_t>(kTileW) * static_cast<std::size_t>(down.height + 8) + kOverrun);
    const int x0 = part.x0 - across.first, y0 = part.y0 - down.first, width = part.width(), height = part.height();
    float* block = work.block.data() + AcrossTaps::kLanes + y0 * stride;
    if (kernel) {
        const int spare = shown.reach - kernel->reach;
        blurBlock(block + x0, stride, width, (height + 3) / 4 * 4, work.sums.data() + spare * work.sumStride + spare,
                  work.sumStride, *kernel);
    } else if (shown.sharp) {
        for (int y = 0; y < height; ++y)
            std::copy_n(work.sums.data() + y * work.sumStride, width, block + y * stride + x0);
    } else {  // one colour is sharp where others are not
        for (int y = 0; y < height; ++y) {
            float* to = block + y * stride + x0;
            const float* above = work.sums.data() + (y + shown.reach) * work.sumStride + shown.reach;
            const float* below = above + work.sumStride;
            for (int x = 0; x < width; ++x)
                to[x] = below[x] - above[x];
        }
    }
    if (width < across.width) {
        for (int y = 0; y < height; ++y) {
            float* row = block + y * stride;
            std::fill_n(row, x0, 0.0F);
            std::fill(row + x0 + width, row + across.width, 0.0F);
        }
    }
    float* spread = work.across.data();
    const int margin = 3;  // rows that interpolation reads beside the part
    const int above = std::max(0, y0 - margin), below = std::min(down.height, y0 + height + margin);
    std::fill(spread + above * kTileW, spread + y0 * kTileW, 0.0F);
    std::fill(spread + (y0 + height) * kTileW, spread + below * kTileW, 0.0F);
    resampleAcross(spread + y0 * kTileW, block, stride, height, across);
    resampleDownAdd(into, spread, y0, y0 + height - 1, down, shares, weight);
}

}  // namespace ilf::view
