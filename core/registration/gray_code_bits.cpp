#include "core/registration/gray_code_bits.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace ilf {

AxisRow::AxisRow(int width) {
    const auto n = static_cast<std::size_t>(width);
    for (auto* numbers : {&code, &weakest, &second, &finest, &even})
        numbers->resize(n);
}

// Each loop runs over one row of one bit, in 16-bit lanes: compilers make vectors of it, and the row stays in cache.

namespace {

void readBit(const BitRows& bit, int width, AxisRow& out) {
    std::int16_t *code = out.code.data(), *weakest = out.weakest.data(), *second = out.second.data();
    for (int x = 0; x < width; ++x) {
        const auto d = static_cast<std::int16_t>(bit.picture[x] - bit.inverse[x]);
        const auto size = static_cast<std::int16_t>(std::max<std::int16_t>(d, static_cast<std::int16_t>(-d)));
        const auto gray = static_cast<std::int16_t>(d > 0);
        code[x] = static_cast<std::int16_t>((code[x] << 1) | ((code[x] & 1) ^ gray));
        second[x] = std::min(second[x], std::max(weakest[x], size));
        weakest[x] = std::min(weakest[x], size);
    }
}

void readFinest(const BitRows& bit, int width, AxisRow& out) {
    std::int16_t *code = out.code.data(), *finest = out.finest.data();
    for (int x = 0; x < width; ++x) {
        const auto d = static_cast<std::int16_t>(bit.picture[x] - bit.inverse[x]);
        const auto gray = static_cast<std::int16_t>(d > 0);
        code[x] = static_cast<std::int16_t>((code[x] << 1) | ((code[x] & 1) ^ gray));
        finest[x] = std::max<std::int16_t>(d, static_cast<std::int16_t>(-d));
    }
}

/// Where the even end of the code is an edge of the bit `level` above the finest, takes its difference.
void takeEven(const BitRows& bit, int level, int width, AxisRow& out) {
    const std::int16_t* code = out.code.data();
    std::int16_t* even = out.even.data();
    const auto mask = static_cast<std::int16_t>((2 << level) - 1);
    const auto edge = static_cast<std::int16_t>(1 << level);
    for (int x = 0; x < width; ++x) {
        const auto d = static_cast<std::int16_t>(bit.picture[x] - bit.inverse[x]);
        const auto size = static_cast<std::int16_t>(std::max<std::int16_t>(d, static_cast<std::int16_t>(-d)));
        const auto end = static_cast<std::int16_t>((code[x] + 1) & ~1);
        even[x] = (end & mask) == edge ? size : even[x];
    }
}

}  // namespace

void readAxis(const std::vector<BitRows>& bits, const std::int16_t* contrast, int width, AxisRow& out) {
    constexpr std::int16_t kNone = 256;  // more than any difference
    std::ranges::fill(out.code, std::int16_t{0});
    std::ranges::fill(out.weakest, kNone);
    std::ranges::fill(out.second, kNone);
    std::copy_n(contrast, width, out.even.begin());
    for (std::size_t i = 0; i + 1 < bits.size(); ++i)
        readBit(bits[i], width, out);
    readFinest(bits.back(), width, out);
    for (std::size_t i = 0; i + 1 < bits.size(); ++i)
        takeEven(bits[i], static_cast<int>(bits.size() - 1 - i), width, out);
}

}  // namespace ilf
