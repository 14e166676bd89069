#include "core/perceived/reference_points.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace ilf::reference {

std::vector<std::array<std::uint32_t, 3>> sobolPoints(int count) {
    // Columns of the generator matrices: van der Corput; x + 1 with m = 1; x^2 + x + 1 with m = 1, 3.
    std::array<std::array<std::uint32_t, 32>, 3> directions{};
    for (std::uint32_t k = 0; k < 32; ++k) {
        auto& [first, second, third] = directions;
        first[k] = 1U << (31U - k);
        second[k] = k < 1 ? 1U << 31U : second[k - 1] ^ (second[k - 1] >> 1U);
        if (k < 2) {
            third[k] = (k == 0 ? 1U : 3U) << (31U - k);
        } else {
            third[k] = third[k - 2] ^ (third[k - 2] >> 2U) ^ third[k - 1];
        }
    }
    std::vector<std::array<std::uint32_t, 3>> points;
    std::array<std::uint32_t, 3> at{};
    for (int i = 0; i < count; ++i) {
        points.push_back(at);
        const auto changing = static_cast<std::size_t>(std::countr_one(static_cast<std::uint32_t>(i)));
        for (std::size_t d = 0; d < 3; ++d)
            at[d] ^= directions[d][changing];
    }
    return points;
}

std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    std::uint64_t z = 0;
    for (const std::uint64_t word : {a, b, c}) {
        // One step of splitmix64 for each number (Steele, Lea and Flood, 2014).
        z = (z ^ word) + 0x9e3779b97f4a7c15ULL;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
        z ^= z >> 31U;
    }
    return z;
}

void onDisc(double u, double v, double& x, double& y) {
    const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
    if (a == 0.0 && b == 0.0) {
        x = y = 0.0;
        return;
    }
    const bool wide = std::abs(a) > std::abs(b);
    const double radius = wide ? a : b;
    const double angle =
        wide ? 0.25 * std::numbers::pi * (b / a) : 0.5 * std::numbers::pi - 0.25 * std::numbers::pi * (a / b);
    x = radius * std::cos(angle);
    y = radius * std::sin(angle);
}

}  // namespace ilf::reference
