// The least largest error of linear functions under bounds: how the drive of a wave is found.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace ilf {

/// Coefficients of linear functions of x, one row each, all of the same length.
struct LinearRows {
    std::size_t columns = 0;
    std::vector<double> values;

    std::size_t count() const { return columns == 0 ? 0 : values.size() / columns; }
    std::span<const double> row(std::size_t i) const { return {values.data() + i * columns, columns}; }
    /// A new row of zeros to fill.
    std::span<double> add();
};

/// Minimise  max_i |error_i . x - target_i| + worth (sum_j size_j x_j^2) / sizeLimit
/// where     low_i <= bounded_i . x <= high_i  and  sum_j size_j x_j^2 <= sizeLimit.
struct Minimax {
    LinearRows error;
    std::vector<double> target;
    LinearRows bounded;
    std::vector<double> low, high;
    std::vector<double> size;
    double sizeLimit = 1.0;
    double worth = 0.0;
};

struct MinimaxSolution {
    std::vector<double> x;
    double largest = 0.0;  ///< max_i |error_i . x - target_i|
};

/// Log-barrier Newton method (Boyd and Vandenberghe, Convex Optimization, 11.3): within `gap` of the least value, and
/// inside every bound. Lawson's reweighting (scheduling 3.4) has no place for bounds. Nothing when x = 0 is not
/// strictly inside the bounds.
std::optional<MinimaxSolution> solved(const Minimax& problem, double gap = 1e-6);

}  // namespace ilf
