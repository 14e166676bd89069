// Low-discrepancy points over pupil and time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace ilf::reference {

/// The first `count` points of the three-dimensional Sobol sequence, as 32-bit fractions. Two dimensions are the pupil,
/// one is time. Source: Bratley and Fox, ACM TOMS 14(1), 1988 (algorithm 659); direction numbers of Joe and Kuo, 2008.
std::vector<std::array<std::uint32_t, 3>> sobolPoints(int count);

/// A digital shift: the sequence stays as even as it was, and each point is uniform over random shifts.
inline double shifted(std::uint32_t fraction, std::uint32_t by) {
    return (static_cast<double>(fraction ^ by) + 0.5) / 4294967296.0;
}

/// Well mixed bits of numbers that are not.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0);

/// Uniform over the unit disc, and continuous, for (u, v) uniform over the unit square. Source: Shirley and Chiu, "A
/// low distortion map between disk and square", 1997.
void onDisc(double u, double v, double& x, double& y);

}  // namespace ilf::reference
