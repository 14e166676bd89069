#include "core/perceived/engine_simd.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

// Highway compiles this file once for each kind of processor; the rest of the program includes none of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/perceived/engine_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#pragma GCC diagnostic pop

HWY_BEFORE_NAMESPACE();
namespace ilf::view::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
/// Sixteen lanes, in as many vectors as that takes.
using Lanes = hn::CappedTag<float, 16>;

/// As many columns of vectors side by side as there are: each sum waits for the one above it, not for its neighbours.
template <std::size_t kVectors, bool kMasked>
HWY_INLINE void prefixColumns(float* HWY_RESTRICT to, int stride, int rows, const float* HWY_RESTRICT mask,
                              int maskStride, float even, const float* HWY_RESTRICT from, int valueStride) {
    const Floats d;
    const auto everywhere = hn::Set(d, even);
    const std::size_t n = hn::Lanes(d);
    using V = decltype(hn::Zero(d));
    std::array<V, kVectors> sums;
    for (std::size_t v = 0; v < kVectors; ++v) {
        sums[v] = hn::Zero(d);
        hn::StoreU(sums[v], d, to + v * n);
    }
    for (int y = 0; y < rows; ++y) {
        to += stride;
        for (std::size_t v = 0; v < kVectors; ++v) {
            const auto value = hn::LoadU(d, from + v * n);
            sums[v] = hn::MulAdd(kMasked ? hn::LoadU(d, mask + v * n) : everywhere, value, sums[v]);
            hn::StoreU(sums[v], d, to + v * n);
        }
        from += valueStride;
        if (kMasked) mask += maskStride;
    }
}

template <bool kMasked>
void prefixOf(float* HWY_RESTRICT sums, int stride, int width, int rows, const float* HWY_RESTRICT mask, int maskStride,
              float even, const float* HWY_RESTRICT values, int valueStride) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (int x = 0; x < width;) {
        const int left = (width - x + n - 1) / n;
        const auto columns = [&](auto vectors) {
            prefixColumns<vectors(), kMasked>(sums + x, stride, rows, kMasked ? mask + x : mask, maskStride, even,
                                              values + x, valueStride);
            x += static_cast<int>(vectors()) * n;
        };
        if (left == 5 || left > 7) {
            columns(std::integral_constant<std::size_t, 5>{});
        } else if (left >= 4) {
            columns(std::integral_constant<std::size_t, 4>{});
        } else if (left == 3) {
            columns(std::integral_constant<std::size_t, 3>{});
        } else if (left == 2) {
            columns(std::integral_constant<std::size_t, 2>{});
        } else {
            columns(std::integral_constant<std::size_t, 1>{});
        }
    }
}

void prefixSumsHere(float* HWY_RESTRICT sums, int stride, int width, int rows, const float* HWY_RESTRICT mask,
                    int maskStride, float even, const float* HWY_RESTRICT values, int valueStride) {
    if (mask) {
        prefixOf<true>(sums, stride, width, rows, mask, maskStride, even, values, valueStride);
    } else {
        prefixOf<false>(sums, stride, width, rows, mask, maskStride, even, values, valueStride);
    }
}

void productsHere(float* HWY_RESTRICT out, int stride, int width, int rows, const float* HWY_RESTRICT mask,
                  int maskStride, float even, const float* HWY_RESTRICT values, int valueStride) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto everywhere = hn::Set(d, even);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < width; x += n) {
            const auto covers = mask ? hn::LoadU(d, mask + y * maskStride + x) : everywhere;
            hn::StoreU(hn::Mul(covers, hn::LoadU(d, values + y * valueStride + x)), d, out + y * stride + x);
        }
    }
}

template <int kFirst, int kCount, class V, std::size_t kVectors>
HWY_INLINE void addSteps(std::array<std::array<V, kVectors>, 4>& rows, const std::vector<EdgeKernel::Step>& steps,
                         const float* HWY_RESTRICT sums, int sumStride) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (const EdgeKernel::Step& step : steps) {
        const float* HWY_RESTRICT at = sums + step.row * sumStride + step.column;
        for (std::size_t v = 0; v < kVectors; ++v) {
            const auto sum = hn::LoadU(d, at + static_cast<int>(v) * n);
            for (std::size_t i = kFirst; i < kFirst + kCount; ++i)
                rows[i][v] = hn::MulAdd(hn::Set(d, step.weights[i]), sum, rows[i][v]);
        }
    }
}

template <std::size_t kVectors>
HWY_INLINE void blurRows(float* HWY_RESTRICT block, int blockStride, const float* HWY_RESTRICT sums, int sumStride,
                         const EdgeKernel& kernel) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    using V = decltype(hn::Zero(d));
    std::array<std::array<V, kVectors>, 4> rows;
    for (auto& row : rows) {
        for (auto& vector : row)
            vector = hn::Zero(d);
    }
    const auto& steps = kernel.steps;
    addSteps<0, 1>(rows, steps[0][0], sums, sumStride);
    addSteps<0, 2>(rows, steps[0][1], sums, sumStride);
    addSteps<0, 3>(rows, steps[0][2], sums, sumStride);
    addSteps<0, 4>(rows, steps[0][3], sums, sumStride);
    addSteps<1, 1>(rows, steps[1][0], sums, sumStride);
    addSteps<1, 2>(rows, steps[1][1], sums, sumStride);
    addSteps<1, 3>(rows, steps[1][2], sums, sumStride);
    addSteps<2, 1>(rows, steps[2][0], sums, sumStride);
    addSteps<2, 2>(rows, steps[2][1], sums, sumStride);
    addSteps<3, 1>(rows, steps[3][0], sums, sumStride);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t v = 0; v < kVectors; ++v)
            hn::StoreU(rows[i][v], d, block + static_cast<int>(i) * blockStride + static_cast<int>(v) * n);
    }
}

void blurBlockHere(float* HWY_RESTRICT block, int blockStride, int width, int height, const float* HWY_RESTRICT sums,
                   int sumStride, const EdgeKernel& kernel) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    // As many vectors side by side as leave room for their sums in registers: the more, the fewer times a weight is
    // read.
    constexpr std::size_t kMost = hn::MaxLanes(d) >= 16 ? 5 : 2;
    const auto rows = [&](auto vectors, int x, int y) {
        blurRows<vectors()>(block + y * blockStride + x, blockStride, sums + y * sumStride + x, sumStride, kernel);
    };
    for (int y = 0; y < height; y += 4) {
        int x = 0;
        for (; kMost == 5 && x + 4 * n < width; x += 5 * n)
            rows(std::integral_constant<std::size_t, kMost>{}, x, y);
        for (; kMost == 5 && x + 2 * n < width; x += 3 * n)
            rows(std::integral_constant < std::size_t, kMost == 5 ? 3 : 2 > {}, x, y);
        for (; x + n < width; x += 2 * n)
            rows(std::integral_constant<std::size_t, 2>{}, x, y);
        if (x < width) rows(std::integral_constant<std::size_t, 1>{}, x, y);
    }
}

/// A row of a tile from the sums of its phases, pixel by pixel in turn.
template <std::size_t kCoarse, class D, class V>
HWY_INLINE void storePhases(D d, const std::array<V, kCoarse>& sums, float* HWY_RESTRICT to) {
    if constexpr (kCoarse == 1) hn::StoreU(sums[0], d, to);
    if constexpr (kCoarse == 2) hn::StoreInterleaved2(sums[0], sums[1], d, to);
    if constexpr (kCoarse == 4) hn::StoreInterleaved4(sums[0], sums[1], sums[2], sums[3], d, to);
}

template <std::size_t kCoarse, std::size_t kTaps>
void acrossAll(float* HWY_RESTRICT out, const float* HWY_RESTRICT block, int blockStride, int rows,
               const AcrossTaps& taps) {
    const Lanes d;
    constexpr int kCoarseInt = static_cast<int>(kCoarse);
    const int n = static_cast<int>(hn::Lanes(d));
    const std::size_t perPhase = kTileW / AcrossTaps::kLanes / kCoarse;
    using V = decltype(hn::Zero(d));
    for (std::size_t group = 0; group < perPhase; ++group) {
        for (int lane = 0; lane < AcrossTaps::kLanes; lane += n) {
            // Weights stay in registers from row to row.
            std::array<std::array<V, kTaps>, kCoarse> weights;
            std::array<const float * HWY_RESTRICT, kCoarse> from;
            for (std::size_t phase = 0; phase < kCoarse; ++phase) {
                const AcrossTaps::Group& of = taps.groups[phase * perPhase + group];
                from[phase] = block + of.base + lane;
                for (std::size_t t = 0; t < kTaps; ++t) {
                    weights[phase][t] = hn::LoadU(d, taps.weights.data() + of.weights +
                                                         static_cast<int>(t) * AcrossTaps::kLanes + lane);
                }
            }
            float* HWY_RESTRICT to = out + kCoarseInt * (static_cast<int>(group) * AcrossTaps::kLanes + lane);
            for (int y = 0; y < rows; ++y) {
                std::array<V, kCoarse> sums;
                for (std::size_t phase = 0; phase < kCoarse; ++phase) {
                    sums[phase] = hn::Mul(weights[phase][0], hn::LoadU(d, from[phase]));
                    for (std::size_t t = 1; t < kTaps; ++t)
                        sums[phase] = hn::MulAdd(weights[phase][t], hn::LoadU(d, from[phase] + t), sums[phase]);
                    from[phase] += blockStride;
                }
                storePhases<kCoarse>(d, sums, to);
                to += kTileW;
            }
        }
    }
}

/// Taps as they come; so many only where a picture is made smaller by a third or more.
template <std::size_t kCoarse>
void acrossMany(float* HWY_RESTRICT out, const float* HWY_RESTRICT block, int blockStride, int rows,
                const AcrossTaps& taps) {
    const Lanes d;
    constexpr int kCoarseInt = static_cast<int>(kCoarse);
    const int n = static_cast<int>(hn::Lanes(d));
    const std::size_t perPhase = kTileW / AcrossTaps::kLanes / kCoarse;
    using V = decltype(hn::Zero(d));
    for (std::size_t group = 0; group < perPhase; ++group) {
        for (int lane = 0; lane < AcrossTaps::kLanes; lane += n) {
            for (int y = 0; y < rows; ++y) {
                std::array<V, kCoarse> sums;
                for (std::size_t phase = 0; phase < kCoarse; ++phase) {
                    const AcrossTaps::Group& of = taps.groups[phase * perPhase + group];
                    const float* HWY_RESTRICT from = block + y * blockStride + of.base + lane;
                    const float* HWY_RESTRICT weights = taps.weights.data() + of.weights + lane;
                    sums[phase] = hn::Zero(d);
                    for (int t = 0; t < taps.taps; ++t) {
                        sums[phase] = hn::MulAdd(hn::LoadU(d, weights + t * AcrossTaps::kLanes), hn::LoadU(d, from + t),
                                                 sums[phase]);
                    }
                }
                storePhases<kCoarse>(
                    d, sums, out + y * kTileW + kCoarseInt * (static_cast<int>(group) * AcrossTaps::kLanes + lane));
            }
        }
    }
}

template <std::size_t kCoarse>
void acrossOf(float* HWY_RESTRICT out, const float* HWY_RESTRICT block, int blockStride, int rows,
              const AcrossTaps& taps) {
    switch (taps.taps) {
    case 4:
        return acrossAll<kCoarse, 4>(out, block, blockStride, rows, taps);
    case 5:
        return acrossAll<kCoarse, 5>(out, block, blockStride, rows, taps);
    case 6:
        return acrossAll<kCoarse, 6>(out, block, blockStride, rows, taps);
    default:
        return acrossMany<kCoarse>(out, block, blockStride, rows, taps);
    }
}

void resampleAcrossHere(float* HWY_RESTRICT out, const float* HWY_RESTRICT block, int blockStride, int rows,
                        const AcrossTaps& taps) {
    if (taps.coarse == 1) return acrossOf<1>(out, block, blockStride, rows, taps);
    if (taps.coarse == 2) return acrossOf<2>(out, block, blockStride, rows, taps);
    return acrossOf<4>(out, block, blockStride, rows, taps);
}

void resampleDownAddHere(float* HWY_RESTRICT into, const float* HWY_RESTRICT across, int firstRow, int lastRow,
                         const DownTaps& taps, const float* HWY_RESTRICT shares, float weight) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (int y = 0; y < kTileH; ++y) {
        const int row = taps.row[static_cast<std::size_t>(y)];
        if (row + 3 < firstRow || row > lastRow) continue;
        const auto& w = taps.weights[static_cast<std::size_t>(y)];
        const float* HWY_RESTRICT from = across + row * kTileW;
        const auto w0 = hn::Set(d, w[0] * weight), w1 = hn::Set(d, w[1] * weight), w2 = hn::Set(d, w[2] * weight),
                   w3 = hn::Set(d, w[3] * weight);
        for (int x = 0; x < kTileW; x += n) {
            auto value = hn::Mul(w0, hn::LoadU(d, from + x));
            value = hn::MulAdd(w1, hn::LoadU(d, from + kTileW + x), value);
            value = hn::MulAdd(w2, hn::LoadU(d, from + 2 * kTileW + x), value);
            value = hn::MulAdd(w3, hn::LoadU(d, from + 3 * kTileW + x), value);
            float* HWY_RESTRICT to = into + y * kTileW + x;
            const auto before = hn::LoadU(d, to);
            hn::StoreU(shares ? hn::MulAdd(hn::LoadU(d, shares + y * kTileW + x), value, before)
                              : hn::Add(before, value),
                       d, to);
        }
    }
}

void addTileHere(float* HWY_RESTRICT into, const float* HWY_RESTRICT shares, const float* HWY_RESTRICT mask,
                 int maskStride, const float* HWY_RESTRICT values, int valueStride, float weight) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto w = hn::Set(d, weight);
    for (int y = 0; y < kTileH; ++y) {
        for (int x = 0; x < kTileW; x += n) {
            const int i = y * kTileW + x;
            auto light = mask ? hn::Mul(w, hn::LoadU(d, mask + y * maskStride + x)) : w;
            if (shares) light = hn::Mul(light, hn::LoadU(d, shares + i));
            hn::StoreU(hn::MulAdd(light, hn::LoadU(d, values + y * valueStride + x), hn::LoadU(d, into + i)), d,
                       into + i);
        }
    }
}

/// Columns of mask * values averaged downwards, rows kept in registers: each is read once.
template <int kCoarse, class Row>
HWY_INLINE void averageDown(float* HWY_RESTRICT lines, int stride, const Row& row) {
    const Lanes d;
    const auto outer = hn::Set(d, kOuterTap), inner = hn::Set(d, kInnerTap);
    const auto half = [&](auto a, auto b, auto c, auto e) {
        return hn::MulAdd(inner, hn::Add(b, c), hn::Mul(outer, hn::Add(a, e)));
    };
    auto a = row(0), b = row(1);
    int next = 2;
    const auto halved = [&] {
        const auto c = row(next), e = row(next + 1);
        next += 2;
        const auto sum = half(a, b, c, e);
        a = c;
        b = e;
        return sum;
    };
    if constexpr (kCoarse == 2) {
        for (int y = 0; y < kTileH / 2; ++y)
            hn::StoreU(halved(), d, lines + y * stride);
    } else {
        auto p = halved(), q = halved();
        for (int y = 0; y < kTileH / 4; ++y) {
            const auto r = halved(), s = halved();
            hn::StoreU(half(p, q, r, s), d, lines + y * stride);
            p = r;
            q = s;
        }
    }
}

/// to = a line averaged to half its width: `count` numbers, rounded up to whole vectors.
HWY_INLINE void averageAcross(float* HWY_RESTRICT to, const float* HWY_RESTRICT line, int count) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto outer = hn::Set(d, kOuterTap), inner = hn::Set(d, kInnerTap);
    for (int x = 0; x < count; x += n) {
        auto a = hn::Zero(d), b = a, c = a, e = a;
        hn::LoadInterleaved2(d, line + 2 * x, a, b);
        hn::LoadInterleaved2(d, line + 2 * x + 2, c, e);
        hn::StoreU(hn::MulAdd(inner, hn::Add(b, c), hn::Mul(outer, hn::Add(a, e))), d, to + x);
    }
}

template <int kCoarse>
void averageBy(float* HWY_RESTRICT out, int outStride, const float* HWY_RESTRICT mask, int maskStride, float even,
               const float* HWY_RESTRICT values, int valueStride) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    constexpr int kRead = kTileW + 16, kStride = kRead + 2 * kOverrun;
    HWY_ALIGN std::array<float, kStride*(kTileH / kCoarse)> lines;
    for (int x = 0; x < kRead; x += n) {
        const auto maskAt = [&](int y) { return hn::LoadU(d, mask + y * maskStride + x); };
        const auto valueAt = [&](int y) { return hn::LoadU(d, values + y * valueStride + x); };
        if (!mask) {
            const auto everywhere = hn::Set(d, even);
            averageDown<kCoarse>(lines.data() + x, kStride, [&](int y) { return hn::Mul(everywhere, valueAt(y)); });
        } else if (!values) {
            averageDown<kCoarse>(lines.data() + x, kStride, maskAt);
        } else {
            averageDown<kCoarse>(lines.data() + x, kStride, [&](int y) { return hn::Mul(maskAt(y), valueAt(y)); });
        }
    }
    for (int y = 0; y < kTileH / kCoarse; ++y) {
        const float* HWY_RESTRICT line = lines.data() + y * kStride;
        float* HWY_RESTRICT to = out + y * outStride;
        if constexpr (kCoarse == 2) {
            averageAcross(to, line, kTileW / 2);
        } else {
            HWY_ALIGN std::array<float, kTileW / 2 + 3 * kOverrun> halves;
            averageAcross(halves.data(), line, kTileW / 2 + 2);
            averageAcross(to, halves.data(), kTileW / 4);
        }
    }
}

void averageTileHere(float* HWY_RESTRICT out, int outStride, int coarse, const float* HWY_RESTRICT mask, int maskStride,
                     float even, const float* HWY_RESTRICT values, int valueStride) {
    if (coarse == 2) return averageBy<2>(out, outStride, mask, maskStride, even, values, valueStride);
    averageBy<4>(out, outStride, mask, maskStride, even, values, valueStride);
}

void keepTileHere(float* HWY_RESTRICT kept, const float* HWY_RESTRICT values, TileBits& bits) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto zero = hn::Zero(d), first = hn::Set(d, values[0]);
    auto uneven = zero;
    const auto ofLanes = [&](auto mask) {
        std::uint64_t one = 0;
        hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&one));
        return one;
    };
    for (std::size_t y = 0; y < kTileH; ++y) {
        std::uint64_t lit = 0, changed = 0;
        for (int x = 0; x < kTileW; x += n) {
            const int i = static_cast<int>(y) * kTileW + x;
            const auto now = hn::LoadU(d, values + i);
            lit |= ofLanes(hn::Gt(now, zero)) << x;
            changed |= ofLanes(hn::Ne(now, hn::LoadU(d, kept + i))) << x;
            uneven = hn::Max(uneven, hn::Abs(hn::Sub(now, first)));
            hn::StoreU(now, d, kept + i);
        }
        bits.lit[y] = lit;
        bits.changed[y] = changed;
    }
    bits.even = hn::AllTrue(d, hn::Eq(uneven, zero));
}

void fromBytesHere(float* HWY_RESTRICT out, const std::uint8_t* HWY_RESTRICT bytes, int count, float unit) {
    const Lanes d;
    const hn::Rebind<std::int32_t, decltype(d)> ints;
    const hn::Rebind<std::uint8_t, decltype(d)> narrow;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto scale = hn::Set(d, unit);
    int i = 0;
    for (; i + n <= count; i += n) {
        const auto wide = hn::PromoteTo(ints, hn::LoadU(narrow, bytes + i));
        hn::StoreU(hn::Mul(hn::ConvertTo(d, wide), scale), d, out + i);
    }
    for (; i < count; ++i)
        out[i] = static_cast<float>(bytes[i]) * unit;
}

void coverageHere(float* HWY_RESTRICT out, int outStride, int width, int rows, const std::array<Factor, 3>& factors) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const Factor &f = factors[0], &g = factors[1], &h = factors[2];
    for (int y = 0; y < rows; ++y) {
        const int row = y * kTileW;
        float* HWY_RESTRICT to = out + y * outStride;
        const auto of = [&](const Factor& factor, int x) {
            return factor.inTile ? hn::LoadU(d, factor.inTile + row + x) : hn::Set(d, factor.even);
        };
        const auto one = [&](const Factor& factor, int x) {
            return factor.inTile ? factor.inTile[row + x] : factor.even;
        };
        int x = 0;
        for (; x + n <= width; x += n)
            hn::StoreU(hn::Mul(hn::Mul(of(f, x), of(g, x)), of(h, x)), d, to + x);
        for (; x < width; ++x)
            to[x] = one(f, x) * one(g, x) * one(h, x);
    }
}

void shareHere(float* HWY_RESTRICT into, const float* HWY_RESTRICT by, bool first) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < kTilePixels; i += n) {
        const auto value = hn::LoadU(d, by + i);
        hn::StoreU(first ? value : hn::Mul(value, hn::LoadU(d, into + i)), d, into + i);
    }
}

void shareWithinHere(float* HWY_RESTRICT into, const float* HWY_RESTRICT by) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0F);
    for (int i = 0; i < kTilePixels; i += n)
        hn::StoreU(hn::Mul(hn::LoadU(d, into + i), hn::Min(hn::Max(hn::LoadU(d, by + i), zero), one)), d, into + i);
}

void settleHere(float* HWY_RESTRICT tile, float rounding) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0F);
    const auto least = hn::Set(d, rounding), most = hn::Set(d, 1.0F - rounding);
    for (int i = 0; i < kTilePixels; i += n) {
        auto value = hn::LoadU(d, tile + i);
        value = hn::IfThenElse(hn::Gt(value, most), one, hn::IfThenElse(hn::Lt(value, least), zero, value));
        hn::StoreU(value, d, tile + i);
    }
}

}  // namespace ilf::view::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ilf::view {

HWY_EXPORT(prefixSumsHere);
HWY_EXPORT(productsHere);
HWY_EXPORT(blurBlockHere);
HWY_EXPORT(resampleAcrossHere);
HWY_EXPORT(resampleDownAddHere);
HWY_EXPORT(addTileHere);
HWY_EXPORT(averageTileHere);
HWY_EXPORT(keepTileHere);
HWY_EXPORT(fromBytesHere);
HWY_EXPORT(coverageHere);
HWY_EXPORT(shareHere);
HWY_EXPORT(shareWithinHere);
HWY_EXPORT(settleHere);

void prefixSums(float* sums, int stride, int width, int rows, const float* mask, int maskStride, float even,
                const float* values, int valueStride) {
    HWY_DYNAMIC_DISPATCH(prefixSumsHere)(sums, stride, width, rows, mask, maskStride, even, values, valueStride);
}
void products(float* out, int stride, int width, int rows, const float* mask, int maskStride, float even,
              const float* values, int valueStride) {
    HWY_DYNAMIC_DISPATCH(productsHere)(out, stride, width, rows, mask, maskStride, even, values, valueStride);
}
void blurBlock(float* block, int blockStride, int width, int height, const float* sums, int sumStride,
               const EdgeKernel& kernel) {
    HWY_DYNAMIC_DISPATCH(blurBlockHere)(block, blockStride, width, height, sums, sumStride, kernel);
}
void resampleAcross(float* out, const float* block, int blockStride, int rows, const AcrossTaps& taps) {
    HWY_DYNAMIC_DISPATCH(resampleAcrossHere)(out, block, blockStride, rows, taps);
}
void resampleDownAdd(float* into, const float* across, int firstRow, int lastRow, const DownTaps& taps,
                     const float* shares, float weight) {
    HWY_DYNAMIC_DISPATCH(resampleDownAddHere)(into, across, firstRow, lastRow, taps, shares, weight);
}
void addTile(float* into, const float* shares, const float* mask, int maskStride, const float* values, int valueStride,
             float weight) {
    HWY_DYNAMIC_DISPATCH(addTileHere)(into, shares, mask, maskStride, values, valueStride, weight);
}
void averageTile(float* out, int outStride, int coarse, const float* mask, int maskStride, float even,
                 const float* values, int valueStride) {
    HWY_DYNAMIC_DISPATCH(averageTileHere)(out, outStride, coarse, mask, maskStride, even, values, valueStride);
}
TileBits keepTile(float* kept, const float* values) {
    TileBits bits;
    HWY_DYNAMIC_DISPATCH(keepTileHere)(kept, values, bits);
    return bits;
}
void fromBytes(float* out, const std::uint8_t* bytes, int count, float unit) {
    HWY_DYNAMIC_DISPATCH(fromBytesHere)(out, bytes, count, unit);
}
void coverage(float* out, int outStride, int width, int rows, const std::array<Factor, 3>& factors) {
    HWY_DYNAMIC_DISPATCH(coverageHere)(out, outStride, width, rows, factors);
}
void share(float* into, const float* by, bool first) { HWY_DYNAMIC_DISPATCH(shareHere)(into, by, first); }
void shareWithin(float* into, const float* by) { HWY_DYNAMIC_DISPATCH(shareWithinHere)(into, by); }
void settle(float* tile, float rounding) { HWY_DYNAMIC_DISPATCH(settleHere)(tile, rounding); }
}  // namespace ilf::view
#endif
