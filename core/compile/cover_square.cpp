#include "core/compile/cover_square.h"

// Highway compiles this file once for each kind of processor; the rest of the program includes none of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/compile/cover_square.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/compile/patch.h"

HWY_BEFORE_NAMESPACE();
namespace ilf::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Numbers = hn::CappedTag<float, static_cast<std::size_t>(kSquare)>;
using Vector = hn::Vec<Numbers>;

/// Of the steps to the two neighbours the smaller one.
HWY_INLINE Vector smoother(Vector before, Vector here, Vector after) {
    const Vector back = hn::Sub(here, before), ahead = hn::Sub(after, here);
    return hn::IfThenElse(hn::Lt(hn::Abs(back), hn::Abs(ahead)), back, ahead);
}

void coverSquareHere(const MaskPatch& patch, const Sampling& sampling, const float* places, std::ptrdiff_t stride,
                     std::uint8_t* to) {
    const Numbers d;
    const hn::Rebind<std::int32_t, Numbers> whole;
    const hn::Rebind<std::uint8_t, Numbers> bytes;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F);
    const auto cornerX = hn::Set(d, static_cast<float>(patch.at.x0) + 0.5F);
    const auto cornerY = hn::Set(d, static_cast<float>(patch.at.y0) + 0.5F);
    // Samples beside the picture are moved to its dark rim.
    const auto endX = hn::Set(d, static_cast<float>(patch.at.width()) - 1.001F);
    const auto endY = hn::Set(d, static_cast<float>(patch.at.height()) - 1.001F);
    const auto overX = hn::Set(d, sampling.overX), overY = hn::Set(d, sampling.overY);
    const auto width = hn::Set(whole, patch.at.width());
    const std::int32_t* from = patch.pairs.data();
    const std::int32_t* below = from + patch.at.width();
    // How much of a box about a point lies beyond the border between two camera pixels.
    const auto beyond = [&](Vector a, Vector overSide) {
        return hn::Min(hn::Max(hn::MulAdd(hn::Sub(a, half), overSide, half), zero), one);
    };
    const auto first = [&](auto pair) { return hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(pair))); };
    const auto second = [&](auto pair) { return hn::ConvertTo(d, hn::ShiftRight<16>(pair)); };

    const int n = sampling.points;
    const float step = 1.0F / static_cast<float>(n), begin = 0.5F * step - 0.5F;
    const auto share = hn::Set(d, step * step / 12.0F);
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int y = 0; y < kSquare; ++y) {
        for (int i = 0; i < kSquare; i += lanes) {
            const float* row = places + y * stride + 2 * i;
            Vector cx, cy, leftX, leftY, rightX, rightY, aboveX, aboveY, belowX, belowY;
            hn::LoadInterleaved2(d, row, cx, cy);
            hn::LoadInterleaved2(d, row - 2, leftX, leftY);
            hn::LoadInterleaved2(d, row + 2, rightX, rightY);
            hn::LoadInterleaved2(d, row - stride, aboveX, aboveY);
            hn::LoadInterleaved2(d, row + stride, belowX, belowY);
            const auto rightwardsX = smoother(leftX, cx, rightX), rightwardsY = smoother(leftY, cy, rightY);
            const auto downX = smoother(aboveX, cx, belowX), downY = smoother(aboveY, cy, belowY);
            auto sum = zero;
            for (int k = 0; k < n; ++k) {
                const auto v = hn::Set(d, begin + static_cast<float>(k) * step);
                const auto lineX = hn::MulAdd(v, downX, cx), lineY = hn::MulAdd(v, downY, cy);
                for (int j = 0; j < n; ++j) {
                    const auto u = hn::Set(d, begin + static_cast<float>(j) * step);
                    const auto x = hn::Sub(hn::MulAdd(u, rightwardsX, lineX), cornerX);
                    const auto yy = hn::Sub(hn::MulAdd(u, rightwardsY, lineY), cornerY);
                    const auto fx = hn::Min(hn::Max(x, zero), endX), fy = hn::Min(hn::Max(yy, zero), endY);
                    const auto ix = hn::ConvertTo(whole, fx), iy = hn::ConvertTo(whole, fy);
                    const auto ax = beyond(hn::Sub(fx, hn::ConvertTo(d, ix)), overX);
                    const auto ay = beyond(hn::Sub(fy, hn::ConvertTo(d, iy)), overY);
                    const auto index = hn::Add(hn::Mul(iy, width), ix);
                    const auto over = hn::GatherIndex(whole, from, index);
                    const auto under = hn::GatherIndex(whole, below, index);
                    const auto a = first(over), c = first(under);
                    const auto top = hn::MulAdd(ax, hn::Sub(second(over), a), a);
                    const auto bottom = hn::MulAdd(ax, hn::Sub(second(under), c), c);
                    sum = hn::Add(sum, hn::MulAdd(ay, hn::Sub(bottom, top), top));
                }
            }
            const auto rounded = hn::ConvertTo(whole, hn::Max(hn::MulAdd(sum, share, half), zero));
            hn::StoreU(hn::DemoteTo(bytes, rounded), bytes, to + y * kTile + i);
        }
    }
}

}  // namespace ilf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ilf {

namespace {

/// Above this many camera pixels a projector pixel, more points are not taken: 8 x 8 a pixel.
constexpr int kMostPoints = 8;

/// One over the side of the boxes that n points along a projector pixel of `reach` camera pixels stand for. Points and
/// boxes together spread as one box of that size does, or as one of a camera pixel where that is larger.
float overSide(int n, double reach) {
    const double whole = std::max(1.0, reach);
    const double side = std::sqrt(whole * whole - reach * reach * (1.0 - 1.0 / (n * n)));
    return static_cast<float>(1.0 / std::clamp(side, 1.0 / kMostPoints, 1.0));
}

}  // namespace

int pointsFor(double scale) { return std::clamp(static_cast<int>(std::ceil(scale - 1e-6)), 1, kMostPoints); }

Sampling samplingFor(int points, double reachX, double reachY) {
    return {points, overSide(points, reachX), overSide(points, reachY)};
}

MaskPatch::MaskPatch(const Mask& mask, PixelRect<CameraFrame> rect)
    : at(rect), plain(gatheredOrZero(mask, rect)), pairs(plain.size()) {
    const auto width = static_cast<std::size_t>(at.width()), height = static_cast<std::size_t>(at.height());
    std::vector<std::int16_t> sharp(width + 1);
    for (std::size_t y = 0; y < height; ++y) {
        // The rim stands for its missing neighbours: nothing is sampled there.
        const std::uint8_t* line = plain.data() + y * width;
        const std::uint8_t* above = y > 0 ? line - width : line;
        const std::uint8_t* below = y + 1 < height ? line + width : line;
        const auto sharpened = [&](std::size_t x, std::size_t left, std::size_t right) {
            return static_cast<std::int16_t>(16 * line[x] - line[left] - line[right] - above[x] - below[x]);
        };
        sharp[0] = sharpened(0, 0, 1);
        for (std::size_t x = 1; x + 1 < width; ++x)
            sharp[x] = sharpened(x, x - 1, x + 1);
        sharp[width] = sharp[width - 1] = sharpened(width - 1, width - 2, width - 1);
        std::int32_t* to = pairs.data() + y * width;
        for (std::size_t x = 0; x < width; ++x)
            to[x] = (sharp[x] & 0xFFFF) | (sharp[x + 1] * 0x10000);
    }
}

std::optional<std::uint8_t> MaskPatch::flatOver(PixelRect<CameraFrame> touched) const {
    const PixelRect<CameraFrame> r{std::clamp(touched.x0, at.x0, at.x1 - 1), std::clamp(touched.y0, at.y0, at.y1 - 1),
                                   std::clamp(touched.x1, at.x0 + 1, at.x1), std::clamp(touched.y1, at.y0 + 1, at.y1)};
    const auto width = static_cast<std::size_t>(at.width());
    const std::uint8_t* first =
        &plain[static_cast<std::size_t>(r.y0 - at.y0) * width + static_cast<std::size_t>(r.x0 - at.x0)];
    const auto bytes = static_cast<std::size_t>(std::max(1, r.width()));
    if (std::memcmp(first, first + 1, bytes - 1) != 0) return std::nullopt;
    const std::uint8_t* line = first;
    for (int y = r.y0 + 1; y < r.y1; ++y)
        if (std::memcmp(first, line += width, bytes) != 0) return std::nullopt;
    return *first;
}

HWY_EXPORT(coverSquareHere);

void coverSquare(const MaskPatch& patch, const Sampling& sampling, const float* places, std::ptrdiff_t stride,
                 std::uint8_t* to) {
    HWY_DYNAMIC_DISPATCH(coverSquareHere)(patch, sampling, places, stride, to);
}

}  // namespace ilf
#endif
