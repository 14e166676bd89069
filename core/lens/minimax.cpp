#include "core/lens/minimax.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace ilf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double dot(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The barrier and its Newton steps. Unknowns: x, then the bound t of the errors.
class Barrier {
public:
    explicit Barrier(const Minimax& problem) : p_(problem), n_(problem.error.columns) {}

    std::size_t terms() const { return 2 * p_.error.count() + 2 * p_.bounded.count() + 1; }

    /// `sharpness` (objective) - sum log(distances to the bounds); infinite outside them.
    double value(const std::vector<double>& v, double sharpness) const {
        const std::span<const double> x(v.data(), n_);
        const double t = v[n_], size = sizeOf(x);
        if (size >= p_.sizeLimit) return kInfinity;
        double f = sharpness * (t + p_.worth * size / p_.sizeLimit) - std::log(p_.sizeLimit - size);
        for (std::size_t i = 0; i < p_.error.count(); ++i) {
            const double e = dot(p_.error.row(i), x) - p_.target[i];
            if (std::abs(e) >= t) return kInfinity;
            f -= std::log((t - e) * (t + e));
        }
        for (std::size_t i = 0; i < p_.bounded.count(); ++i) {
            const double y = dot(p_.bounded.row(i), x);
            if (y <= p_.low[i] || y >= p_.high[i]) return kInfinity;
            f -= std::log((y - p_.low[i]) * (p_.high[i] - y));
        }
        return f;
    }

    /// One damped Newton step; the squared Newton decrement before it.
    double step(std::vector<double>& v, double sharpness) {
        differentiate(v, sharpness);
        std::vector<double> move = newton();
        const double decrement = -dot(move, gradient_);
        const double before = value(v, sharpness);
        for (double length = 1.0; length > 1e-12; length *= 0.5) {
            std::vector<double> next = v;
            for (std::size_t i = 0; i <= n_; ++i)
                next[i] += length * move[i];
            if (value(next, sharpness) <= before - 0.1 * length * decrement) {
                v = std::move(next);
                return decrement;
            }
        }
        return 0.0;  // rounding: no step lowers it any more
    }

    double sizeOf(std::span<const double> x) const {
        double size = 0.0;
        for (std::size_t i = 0; i < n_; ++i)
            size += p_.size[i] * x[i] * x[i];
        return size;
    }

private:
    /// H += curvature row row^T, lower triangle.
    void addSquare(std::span<const double> row, double curvature) {
        for (std::size_t i = 0; i < n_; ++i) {
            const double scaled = curvature * row[i];
            for (std::size_t j = 0; j <= i; ++j)
                hessian_[i * (n_ + 1) + j] += scaled * row[j];
        }
    }

    void differentiate(const std::vector<double>& v, double sharpness) {
        const std::span<const double> x(v.data(), n_);
        const double t = v[n_];
        gradient_.assign(n_ + 1, 0.0);
        hessian_.assign((n_ + 1) * (n_ + 1), 0.0);
        gradient_[n_] = sharpness;
        double* const lastRow = hessian_.data() + n_ * (n_ + 1);
        for (std::size_t i = 0; i < p_.error.count(); ++i) {
            const std::span<const double> row = p_.error.row(i);
            const double e = dot(row, x) - p_.target[i];
            const double above = 1.0 / (t - e), below = 1.0 / (t + e);
            addSquare(row, above * above + below * below);
            for (std::size_t j = 0; j < n_; ++j) {
                gradient_[j] += (above - below) * row[j];
                lastRow[j] -= (above * above - below * below) * row[j];
            }
            gradient_[n_] -= above + below;
            lastRow[n_] += above * above + below * below;
        }
        for (std::size_t i = 0; i < p_.bounded.count(); ++i) {
            const std::span<const double> row = p_.bounded.row(i);
            const double y = dot(row, x);
            const double above = 1.0 / (p_.high[i] - y), below = 1.0 / (y - p_.low[i]);
            addSquare(row, above * above + below * below);
            for (std::size_t j = 0; j < n_; ++j)
                gradient_[j] += (above - below) * row[j];
        }
        const double room = 1.0 / (p_.sizeLimit - sizeOf(x));
        const double worth = sharpness * p_.worth / p_.sizeLimit;
        std::vector<double> sizeSlope(n_);
        for (std::size_t j = 0; j < n_; ++j) {
            sizeSlope[j] = 2.0 * p_.size[j] * x[j];
            gradient_[j] += (room + worth) * sizeSlope[j];
            hessian_[j * (n_ + 1) + j] += 2.0 * (room + worth) * p_.size[j];
        }
        addSquare(sizeSlope, room * room);
    }

    /// -H^-1 gradient by Cholesky's factors; H is positive definite inside the bounds.
    std::vector<double> newton() {
        const std::size_t m = n_ + 1;
        const auto h = [&](std::size_t i, std::size_t j) -> double& { return hessian_[i * m + j]; };
        for (std::size_t j = 0; j < m; ++j) {
            for (std::size_t k = 0; k < j; ++k)
                h(j, j) -= h(j, k) * h(j, k);
            // An unknown that moves nothing stays where it is.
            h(j, j) = h(j, j) > 0.0 ? std::sqrt(h(j, j)) : kInfinity;
            for (std::size_t i = j + 1; i < m; ++i) {
                for (std::size_t k = 0; k < j; ++k)
                    h(i, j) -= h(i, k) * h(j, k);
                h(i, j) /= h(j, j);
            }
        }
        std::vector<double> s(m);
        for (std::size_t i = 0; i < m; ++i) {
            s[i] = -gradient_[i];
            for (std::size_t k = 0; k < i; ++k)
                s[i] -= h(i, k) * s[k];
            s[i] /= h(i, i);
        }
        for (std::size_t i = m; i-- > 0;) {
            for (std::size_t k = i + 1; k < m; ++k)
                s[i] -= h(k, i) * s[k];
            s[i] /= h(i, i);
        }
        return s;
    }

    const Minimax& p_;
    std::size_t n_;
    std::vector<double> gradient_, hessian_;
};

double largestError(const Minimax& problem, std::span<const double> x) {
    double largest = 0.0;
    for (std::size_t i = 0; i < problem.error.count(); ++i)
        largest = std::max(largest, std::abs(dot(problem.error.row(i), x) - problem.target[i]));
    return largest;
}

}  // namespace

std::span<double> LinearRows::add() {
    values.resize(values.size() + columns);
    return {values.data() + values.size() - columns, columns};
}

std::optional<MinimaxSolution> solved(const Minimax& problem, double gap) {
    const std::size_t n = problem.error.columns;
    assert(problem.target.size() == problem.error.count() && problem.size.size() == n);
    assert(problem.low.size() == problem.bounded.count() && problem.high.size() == problem.bounded.count());
    const std::vector<double> zero(n);
    std::vector<double> v(n + 1);
    v[n] = 1.5 * largestError(problem, zero) + gap;

    Barrier barrier(problem);
    // Each tightening multiplies by 20 and takes some ten steps; smaller factors take more tightenings.
    double sharpness = static_cast<double>(barrier.terms()) / v[n];
    if (!std::isfinite(barrier.value(v, sharpness))) return std::nullopt;
    for (;;) {
        for (int i = 0; i < 60 && barrier.step(v, sharpness) > 1e-6; ++i) {
        }
        if (static_cast<double>(barrier.terms()) / sharpness < gap) break;
        sharpness *= 20.0;
    }
    v.resize(n);
    const double largest = largestError(problem, v);
    return MinimaxSolution{std::move(v), largest};
}

}  // namespace ilf
