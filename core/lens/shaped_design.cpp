#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "core/lens/minimax.h"
#include "core/lens/shaped_model.h"

namespace ilf {
namespace {

constexpr int kSweepSamples = 512;  ///< a sweep: 16 harmonics deviate from their samples by less than 1 %
/// What driving at the rms limit must gain: a coil as hot as it may be is not worth 2 mD.
constexpr double kDriveWorth_D = 2e-3;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

/// Every sample inside `hold`, its two ends included.
template <class Visit>
void forSamples(const Hold& hold, Visit visit) {
    const int count = std::max(1, static_cast<int>(std::ceil(hold.length * kSweepSamples)));
    for (int i = 0; i <= count; ++i)
        visit(hold.centre + hold.length * (static_cast<double>(i) / count - 0.5));
}

/// The drive's value at x: unknowns are the mean, then real and imaginary part of each harmonic.
void driveRow(std::span<double> row, double x) {
    row[0] = 1.0;
    for (std::size_t k = 1; 2 * k < row.size(); ++k) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) * x;
        row[2 * k - 1] = std::cos(angle);
        row[2 * k] = -std::sin(angle);
    }
}

/// The power's value at x, of a drive counted in units of `peak`.
void powerRow(std::span<double> row, double x, const PowerModel& model, double peak) {
    for (std::size_t j = 0; j < row.size(); ++j)
        row[j] = peak * model.slopes[j].at(x);
}

Minimax problemOf(const PowerModel& model, std::span<const Hold> holds, const DriveLimits& limits) {
    Minimax problem;
    const std::size_t columns = model.slopes.size();
    problem.error.columns = problem.bounded.columns = columns;
    for (const Hold& hold : holds) {
        forSamples(hold, [&](double x) {
            powerRow(problem.error.add(), x, model, limits.peak);
            problem.target.push_back(hold.power_D - model.rest.at(x));
        });
    }
    // Between samples a sum of K harmonics rises above them by at most 1 / cos(pi K / samples).
    const int harmonics = static_cast<int>(model.harmonics()), samples = 16 * harmonics + 16;
    const double peak = std::cos(std::numbers::pi * harmonics / samples);
    for (int i = 0; i < samples; ++i) {
        const double x = static_cast<double>(i) / samples;
        driveRow(problem.bounded.add(), x);
        problem.low.push_back(-peak);
        problem.high.push_back(peak);
        powerRow(problem.bounded.add(), x, model, limits.peak);
        const double rest = model.rest.at(x);
        problem.low.push_back(limits.lensMin.si() - rest);
        problem.high.push_back(limits.lensMax.si() - rest);
    }
    problem.size.assign(columns, 0.5);
    problem.size[0] = 1.0;
    const double rms = limits.rms / limits.peak;
    problem.sizeLimit = rms * rms * (1.0 - 1e-12);  // rounding stays inside
    problem.worth = kDriveWorth_D;
    return problem;
}

}  // namespace

std::vector<Hold> holdsFor(std::span<const double> levels_D, double duty, double lowAt) {
    const std::size_t n = levels_D.size();
    if (n == 0) return {};
    // Every other level on the way up, the rest on the way down.
    std::vector<double> order;
    for (std::size_t i = 0; i < n; i += i == 0 ? 1 : 2)
        order.push_back(levels_D[i]);
    for (std::size_t i = n; i-- > 1;) {
        if (i % 2 == 0) order.push_back(levels_D[i]);
    }
    // A step takes the lens longer the higher it is, but not in proportion: with the root of its height the design's
    // error is within a fifth of what any other power of it gives.
    std::vector<double> gaps;
    for (std::size_t i = 0; i < n; ++i)
        gaps.push_back(std::sqrt(std::abs(order[(i + 1) % n] - order[i])));
    const double heights = std::accumulate(gaps.begin(), gaps.end(), 0.0);
    const double room = std::max(1.0 - static_cast<double>(n) * duty, 0.0);

    std::vector<Hold> holds;
    double centre = lowAt;
    for (std::size_t i = 0; i < n; ++i) {
        double wrapped = centre - std::floor(centre);
        if (wrapped == 1.0) wrapped = 0.0;  // a hair below 0 rounds up
        holds.push_back({wrapped, duty, order[i]});
        centre += duty + (heights > 0.0 ? room * gaps[i] / heights : 0.0);
    }
    std::ranges::sort(holds, {}, &Hold::centre);
    return holds;
}

Result<void> checkedHolds(std::span<const Hold> holds) {
    if (holds.empty()) return fail(Fault::outOfRange, "A shaped wave needs at least one level to hold.");
    std::vector<std::pair<double, double>> spans;
    double total = 0.0;
    for (const Hold& hold : holds) {
        if (!std::isfinite(hold.centre) || !std::isfinite(hold.power_D) || !(hold.length > 0.0))
            return fail(Fault::outOfRange, "A hold needs a finite power and time, and a length above 0.");
        const double start = hold.centre - 0.5 * hold.length;
        spans.emplace_back(start - std::floor(start), hold.length);
        total += hold.length;
    }
    if (!(total < 1.0))
        return fail(Fault::outOfRange,
                    "Holds of " + number(100.0 * total) +
                        " % of the sweep together leave no time to move between them; shorten them.");
    std::ranges::sort(spans);
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const double next = i + 1 < spans.size() ? spans[i + 1].first : spans[0].first + 1.0;
        if (spans[i].first + spans[i].second > next + 1e-12)
            return fail(Fault::outOfRange, "Two holds overlap at " + number(100.0 * (next - std::floor(next))) +
                                               " % of the sweep; the lens has one power at a time.");
    }
    return {};
}

double largestErrorIn(std::span<const Hold> holds, const Harmonics& power) {
    double largest = 0.0;
    for (const Hold& hold : holds)
        forSamples(hold, [&](double x) { largest = std::max(largest, std::abs(power.at(x) - hold.power_D)); });
    return largest;
}

Result<ShapedDesign> designed(const LensResponse& response, std::span<const Hold> holds, int harmonics,
                              const DriveLimits& limits) {
    assert(harmonics >= 1);
    return designed(modelOf(response, static_cast<std::size_t>(harmonics)), holds, limits);
}

Result<ShapedDesign> designed(const PowerModel& model, std::span<const Hold> holds, const DriveLimits& limits) {
    if (const auto fine = checkedHolds(holds); !fine) return tl::unexpected(fine.error());
    if (!(limits.peak > 0.0) || !(limits.rms > 0.0))
        return fail(Fault::outOfRange, "The lens has no drive limits above 0; nothing can be played on it.");
    auto solution = solved(problemOf(model, holds, limits));
    if (!solution)
        return fail(Fault::unsafe, "Undriven, the lens lies at " + number(model.rest.mean()) +
                                       " D, outside its own limits; check the lens or its limits.");
    for (double& x : solution->x)
        x *= limits.peak;

    ShapedDesign design;
    design.drive = driveOf(solution->x);
    design.power = model.power(design.drive);
    design.largestError_D = largestErrorIn(holds, design.power);

    // Nearer to another level than to its own by a quarter: that is another wave, not this one worn badly.
    const auto [low, high] = std::ranges::minmax_element(holds, {}, &Hold::power_D);
    const double span = high->power_D - low->power_D;
    if (design.largestError_D > std::max(0.25 * span, 0.25))
        return fail(Fault::outOfRange, "The lens cannot hold " + number(low->power_D) + " to " + number(high->power_D) +
                                           " D at " + number(model.rate.si()) + " Hz within its drive limits (" +
                                           number(limits.peak) + " " + std::string(word(model.unit)) +
                                           " peak): it would be " + number(design.largestError_D) +
                                           " D off; a slower sweep, shorter holds or a smaller range would help.");
    return design;
}

}  // namespace ilf
