// Inside the decoder: how many of the pixels around each say the same, compiled for several processors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ilf {

/// How far around a pixel others are asked.
constexpr int kAgreeReach = 2;
/// Numbers that are read and written beyond the end of a row: rows need as many to spare.
constexpr std::size_t kAgreeOverrun = 64;

/// A field of departures from the trend, x and y, with a margin of kAgreeReach all round.
struct Departures {
    const std::int16_t *x, *y;  ///< the row's first pixel
    std::ptrdiff_t stride;      ///< from row to row
    std::int16_t nowhere;       ///< of a pixel that says nothing; far from any other number
};

/// Of one row's pixels, each over the 25 around it and itself.
struct Agreement {
    explicit Agreement(std::size_t width) : agree(width + kAgreeOverrun), known(agree), sumX(agree), sumY(agree) {}
    std::vector<std::int16_t> agree;  ///< those that differ by less than `gateX` and `gateY`
    std::vector<std::int16_t> known;  ///< those that say anything
    std::vector<std::int16_t> sumX;   ///< by how much those that agree differ, added up
    std::vector<std::int16_t> sumY;
};

/// Differences within the gates must add up in 16 bits, 25 of them.
void countAgreeing(const Departures& of, int width, std::int16_t gateX, std::int16_t gateY, Agreement& out);

}  // namespace ilf
