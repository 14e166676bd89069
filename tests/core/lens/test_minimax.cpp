#include "core/lens/minimax.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/law.h"

using namespace ilf;

namespace {

Minimax unbounded(std::size_t columns) {
    Minimax problem;
    problem.error.columns = problem.bounded.columns = columns;
    problem.size.assign(columns, 1.0);
    problem.sizeLimit = 1e6;
    return problem;
}

void addError(Minimax& problem, const std::vector<double>& row, double target) {
    std::ranges::copy(row, problem.error.add().begin());
    problem.target.push_back(target);
}

double largestError(const Minimax& problem, const std::vector<double>& x) {
    double largest = 0.0;
    for (std::size_t i = 0; i < problem.error.count(); ++i) {
        double e = -problem.target[i];
        for (std::size_t j = 0; j < x.size(); ++j)
            e += problem.error.row(i)[j] * x[j];
        largest = std::max(largest, std::abs(e));
    }
    return largest;
}

}  // namespace

TEST_CASE("minimax: the constant nearest to 0, 1 and 4 is 2, and is 2 off") {
    Minimax problem = unbounded(1);
    for (const double target : {0.0, 1.0, 4.0})
        addError(problem, {1.0}, target);
    const auto best = solved(problem);
    REQUIRE(best);
    CHECK(best->x[0] == doctest::Approx(2.0).epsilon(1e-5));
    CHECK(best->largest == doctest::Approx(2.0).epsilon(1e-5));
}

TEST_CASE("minimax: the line nearest to a parabola is Chebyshev's, an eighth off") {
    Minimax problem = unbounded(2);
    for (int i = 0; i <= 200; ++i) {
        const double x = i / 200.0;
        addError(problem, {1.0, x}, x * x);
    }
    const auto best = solved(problem);
    REQUIRE(best);
    CHECK(best->largest == doctest::Approx(0.125).epsilon(1e-4));
    CHECK(best->x[1] == doctest::Approx(1.0).epsilon(1e-3));
}

TEST_CASE("minimax: bounds hold, and what they forbid is lacking") {
    Minimax problem = unbounded(1);
    addError(problem, {1.0}, 3.0);
    problem.bounded.add()[0] = 2.0;
    problem.low = {-1.0};
    problem.high = {1.0};
    const auto bounded = solved(problem);
    REQUIRE(bounded);
    CHECK(2.0 * bounded->x[0] <= 1.0);
    CHECK(bounded->largest == doctest::Approx(2.5).epsilon(1e-4));
    problem.sizeLimit = 0.04;
    const auto small = solved(problem);
    REQUIRE(small);
    CHECK(small->x[0] <= 0.2);
    CHECK(small->largest == doctest::Approx(2.8).epsilon(1e-4));
}

TEST_CASE("minimax: bounds that leave out 0 are refused") {
    Minimax problem = unbounded(1);
    addError(problem, {1.0}, 3.0);
    problem.bounded.add()[0] = 1.0;
    problem.low = {1.0};
    problem.high = {2.0};
    CHECK(!solved(problem));
}

TEST_CASE("minimax: an unknown that moves nothing stays at 0 and harms nobody") {
    Minimax problem = unbounded(2);
    addError(problem, {1.0, 0.0}, 1.0);
    const auto best = solved(problem);
    REQUIRE(best);
    CHECK(best->x[0] == doctest::Approx(1.0).epsilon(1e-4));
    CHECK(std::abs(best->x[1]) < 1e-9);
}

TEST_CASE("minimax: no other point inside the bounds is better") {
    law("random problems against random points", [](const std::vector<std::uint8_t>& bytes) {
        const auto unit = [&](std::size_t i) {
            const double mixed =
                std::sin(12.9898 * static_cast<double>(i + 1) + (bytes.empty() ? 0.0 : bytes[i % bytes.size()]));
            return mixed;
        };
        Minimax problem = unbounded(3);
        problem.sizeLimit = 4.0;
        std::size_t next = 0;
        const auto random = [&] { return unit(next++); };
        for (int i = 0; i < 20; ++i)
            addError(problem, {random(), random(), random()}, 2.0 * random());
        for (int i = 0; i < 4; ++i) {
            for (double& value : problem.bounded.add())
                value = random();
            problem.low.push_back(-0.5);
            problem.high.push_back(0.5);
        }
        const auto best = solved(problem);
        RC_ASSERT(best.has_value());
        RC_ASSERT(std::abs(best->largest - largestError(problem, best->x)) < 1e-12);
        for (int trial = 0; trial < 50; ++trial) {
            std::vector<double> x = best->x;
            for (double& value : x)
                value += 0.3 * random();
            double size = 0.0;
            for (const double value : x)
                size += value * value;
            bool inside = size <= problem.sizeLimit;
            for (std::size_t i = 0; i < problem.bounded.count(); ++i) {
                double y = 0.0;
                for (std::size_t j = 0; j < 3; ++j)
                    y += problem.bounded.row(i)[j] * x[j];
                inside = inside && std::abs(y) <= 0.5;
            }
            if (inside) RC_ASSERT(largestError(problem, x) > best->largest - 1e-5);
        }
    });
}
