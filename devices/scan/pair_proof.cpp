#include "devices/scan/pair_proof.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace ilf::devices {
namespace {

constexpr int kClear = 16;      // codes of white above black, well above noise
constexpr double kNear = 0.25;  // of them: bright or dark for sure

}  // namespace

PairProof pairProof(const Image<std::uint8_t>& white, const Image<std::uint8_t>& black,
                    const Image<std::uint8_t>& picture, const Image<std::uint8_t>& inverse) {
    assert(white.size() == black.size() && white.size() == picture.size() && white.size() == inverse.size());
    const auto w = white.pixels(), b = black.pixels(), p = picture.pixels(), q = inverse.pixels();
    std::size_t lit = 0, same = 0, told = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
        const int contrast = int(w[i]) - int(b[i]);
        if (contrast < kClear || w[i] == 255) continue;  // at the sensor's end nothing is told
        ++lit;
        const double x = (p[i] - b[i]) / double(contrast), y = (q[i] - b[i]) / double(contrast);
        const bool xBright = x > 1.0 - kNear, yBright = y > 1.0 - kNear, xDark = x < kNear, yDark = y < kNear;
        if ((xBright && yBright) || (xDark && yDark)) ++same;
        if ((xBright && yDark) || (xDark && yBright)) ++told;
    }
    PairProof proof;
    if (lit == 0) return proof;
    proof.lit = static_cast<double>(lit) / static_cast<double>(w.size());
    proof.same = static_cast<double>(same) / static_cast<double>(lit);
    proof.told = static_cast<double>(told) / static_cast<double>(lit);
    return proof;
}

bool clearlyLit(int white, int black) { return white - black >= kClear; }

bool looksDifferent(int white, int black, int again) {
    return clearlyLit(white, black) && std::abs(white - again) > std::max(8, (white - black) / 8);
}

double meanDifference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
    assert(a.size() == b.size());
    const auto p = a.pixels(), q = b.pixels();
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        sum += static_cast<std::uint64_t>(std::abs(int(p[i]) - int(q[i])));
    return p.empty() ? 0.0 : static_cast<double>(sum) / static_cast<double>(p.size());
}

}  // namespace ilf::devices
