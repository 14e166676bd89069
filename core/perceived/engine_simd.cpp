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

void prefixSumsHere(float* HWY_RESTRICT sums, int stride, int width, int rows, const float* HWY_RESTRICT mask,
                    int maskStride, const float* HWY_RESTRICT values, int valueStride) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    // Four columns of vectors at once: each sum waits for the one above it.
    int x = 0;
    for (; x + 3 * n < width; x += 4 * n) {
        auto a = hn::Zero(d), b = a, c = a, e = a;
        for (float* zero = sums + x; zero < sums + x + 4 * n; zero += n)
            hn::StoreU(a, d, zero);
        for (int y = 0; y < rows; ++y) {
            const float* HWY_RESTRICT from = values + y * valueStride + x;
            float* HWY_RESTRICT to = sums + (y + 1) * stride + x;
            if (mask) {
                const float* HWY_RESTRICT covers = mask + y * maskStride + x;
                a = hn::MulAdd(hn::LoadU(d, covers), hn::LoadU(d, from), a);
                b = hn::MulAdd(hn::LoadU(d, covers + n), hn::LoadU(d, from + n), b);
                c = hn::MulAdd(hn::LoadU(d, covers + 2 * n), hn::LoadU(d, from + 2 * n), c);
                e = hn::MulAdd(hn::LoadU(d, covers + 3 * n), hn::LoadU(d, from + 3 * n), e);
            } else {
                a = hn::Add(a, hn::LoadU(d, from));
                b = hn::Add(b, hn::LoadU(d, from + n));
                c = hn::Add(c, hn::LoadU(d, from + 2 * n));
                e = hn::Add(e, hn::LoadU(d, from + 3 * n));
            }
            hn::StoreU(a, d, to);
            hn::StoreU(b, d, to + n);
            hn::StoreU(c, d, to + 2 * n);
            hn::StoreU(e, d, to + 3 * n);
        }
    }
    for (; x < width; x += n) {
        auto sum = hn::Zero(d);
        hn::StoreU(sum, d, sums + x);
        for (int y = 0; y < rows; ++y) {
            const auto value = hn::LoadU(d, values + y * valueStride + x);
            sum = mask ? hn::MulAdd(hn::LoadU(d, mask + y * maskStride + x), value, sum) : hn::Add(sum, value);
            hn::StoreU(sum, d, sums + (y + 1) * stride + x);
        }
    }
}

void productsHere(float* HWY_RESTRICT out, int stride, int width, int rows, const float* HWY_RESTRICT mask,
                  int maskStride, const float* HWY_RESTRICT values, int valueStride) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < width; x += n) {
            auto value = hn::LoadU(d, mask + y * maskStride + x);
            if (values) value = hn::Mul(value, hn::LoadU(d, values + y * valueStride + x));
            hn::StoreU(value, d, out + y * stride + x);
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

void resampleAcrossHere(float* HWY_RESTRICT out, const float* HWY_RESTRICT block, int blockStride, int rows,
                        const AcrossTaps& taps) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const int coarse = taps.coarse;
    HWY_ALIGN std::array<float, kTileW> phases;
    for (int y = 0; y < rows; ++y) {
        const float* HWY_RESTRICT row = block + y * blockStride;
        float* HWY_RESTRICT to = coarse == 1 ? out + y * kTileW : phases.data();
        const int perPhase = kTileW / coarse;
        for (const AcrossTaps::Group& group : taps.groups) {
            const float* HWY_RESTRICT from = row + group.base;
            const float* HWY_RESTRICT weights = taps.weights.data() + group.weights;
            float* HWY_RESTRICT into = to + group.phase * perPhase + group.start;
            for (int lane = 0; lane < AcrossTaps::kLanes; lane += n) {
                auto sum = hn::Zero(d);
                for (int t = 0; t < group.taps; ++t) {
                    sum = hn::MulAdd(hn::LoadU(d, weights + t * AcrossTaps::kLanes + lane),
                                     hn::LoadU(d, from + t + lane), sum);
                }
                hn::StoreU(sum, d, into + lane);
            }
        }
        float* HWY_RESTRICT line = out + y * kTileW;
        if (coarse == 2) {
            for (int x = 0; x < kTileW / 2; ++x) {
                line[2 * x] = phases[static_cast<std::size_t>(x)];
                line[2 * x + 1] = phases[static_cast<std::size_t>(x + kTileW / 2)];
            }
        } else if (coarse == 4) {
            for (int x = 0; x < kTileW / 4; ++x) {
                for (int q = 0; q < 4; ++q)
                    line[4 * x + q] = phases[static_cast<std::size_t>(x + q * kTileW / 4)];
            }
        }
    }
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
                 const float* HWY_RESTRICT values, int valueStride, float weight) {
    const Floats d;
    const int n = static_cast<int>(hn::Lanes(d));
    const auto w = hn::Set(d, weight);
    for (int y = 0; y < kTileH; ++y) {
        for (int x = 0; x < kTileW; x += n) {
            const int i = y * kTileW + x;
            auto light = hn::Mul(w, hn::LoadU(d, mask + i));
            if (shares) light = hn::Mul(light, hn::LoadU(d, shares + i));
            hn::StoreU(hn::MulAdd(light, hn::LoadU(d, values + y * valueStride + x), hn::LoadU(d, into + i)), d,
                       into + i);
        }
    }
}

void averageTileHere(float* HWY_RESTRICT out, int outStride, int coarse, const float* HWY_RESTRICT mask, int maskStride,
                     const float* HWY_RESTRICT values, int valueStride, const Averaging& averaging) {
    const Lanes d;
    const int n = static_cast<int>(hn::Lanes(d));
    const int lead = averaging.lead, taps = static_cast<int>(averaging.taps.size());
    const int rows = kTileH + 2 * lead;
    constexpr int kStride = kTileW + 16 + kOverrun;  // 70 pixels are read, and whole vectors
    HWY_ALIGN std::array<float, kStride*(kTileH + 6)> products;
    // All rows down before any is read across: a load that straddles fresh stores has to wait for them.
    HWY_ALIGN std::array<float, kStride*(kTileH / 2)> lines;
    for (int y = 0; y < rows; ++y) {
        float* HWY_RESTRICT to = products.data() + y * kStride;
        const float* HWY_RESTRICT covers = mask + y * maskStride;
        for (int x = 0; x < kTileW + 16; x += n) {
            auto value = hn::LoadU(d, covers + x);
            if (values) value = hn::Mul(value, hn::LoadU(d, values + y * valueStride + x));
            hn::StoreU(value, d, to + x);
        }
    }
    for (int y = 0; y < kTileH / coarse; ++y) {
        const float* HWY_RESTRICT from = products.data() + y * coarse * kStride;
        for (int x = 0; x < kTileW + 16; x += n) {
            auto sum = hn::Zero(d);
            for (int t = 0; t < taps; ++t) {
                sum = hn::MulAdd(hn::Set(d, averaging.taps[static_cast<std::size_t>(t)]),
                                 hn::LoadU(d, from + t * kStride + x), sum);
            }
            hn::StoreU(sum, d, lines.data() + y * kStride + x);
        }
    }
    for (int y = 0; y < kTileH / coarse; ++y) {
        const float* HWY_RESTRICT line = lines.data() + y * kStride;
        float* HWY_RESTRICT to = out + y * outStride;
        for (int x = 0; x < kTileW / coarse; x += n) {
            auto sum = hn::Zero(d);
            // Every second (fourth) pixel by de-interleaving: taps 0..1 (0..3) share a load.
            for (int t = 0; t < taps; t += coarse) {
                auto a = hn::Zero(d), b = a, c = a, e = a;
                if (coarse == 2) {
                    hn::LoadInterleaved2(d, line + 2 * x + t, a, b);
                } else {
                    hn::LoadInterleaved4(d, line + 4 * x + t, a, b, c, e);
                }
                const auto weight = [&](int i) {
                    return hn::Set(d, t + i < taps ? averaging.taps[static_cast<std::size_t>(t + i)] : 0.0F);
                };
                sum = hn::MulAdd(weight(0), a, sum);
                sum = hn::MulAdd(weight(1), b, sum);
                if (coarse == 4) {
                    sum = hn::MulAdd(weight(2), c, sum);
                    sum = hn::MulAdd(weight(3), e, sum);
                }
            }
            hn::StoreU(sum, d, to + x);
        }
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

void prefixSums(float* sums, int stride, int width, int rows, const float* mask, int maskStride, const float* values,
                int valueStride) {
    HWY_DYNAMIC_DISPATCH(prefixSumsHere)(sums, stride, width, rows, mask, maskStride, values, valueStride);
}
void products(float* out, int stride, int width, int rows, const float* mask, int maskStride, const float* values,
              int valueStride) {
    HWY_DYNAMIC_DISPATCH(productsHere)(out, stride, width, rows, mask, maskStride, values, valueStride);
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
void addTile(float* into, const float* shares, const float* mask, const float* values, int valueStride, float weight) {
    HWY_DYNAMIC_DISPATCH(addTileHere)(into, shares, mask, values, valueStride, weight);
}
void averageTile(float* out, int outStride, int coarse, const float* mask, int maskStride, const float* values,
                 int valueStride, const Averaging& averaging) {
    HWY_DYNAMIC_DISPATCH(averageTileHere)
    (out, outStride, coarse, mask, maskStride, values, valueStride, averaging);
}
}  // namespace ilf::view
#endif
