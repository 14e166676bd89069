#include <algorithm>
#include <array>
#include <cmath>

#include "devices/measure/edge_delay.h"

namespace ilf::devices {
namespace {

constexpr std::size_t kFewestForPace = 8;
constexpr double kLongestGap = 8.0;  // frames; a longer one ends the pattern

/// The longest stretch without a long gap.
std::vector<LightEdge> longestRun(const std::vector<LightEdge>& edges, double interval) {
    std::size_t best = 0, length = 0, from = 0;
    for (std::size_t i = 1; i <= edges.size(); ++i) {
        const bool ends = i == edges.size() || edges[i].time_s - edges[i - 1].time_s > kLongestGap * interval;
        if (!ends) continue;
        if (i - from > length) {
            best = from;
            length = i - from;
        }
        from = i;
    }
    const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(best);
    return {begin, begin + static_cast<std::ptrdiff_t>(length)};
}

/// Least squares of t = start + interval frame + later [falling].
struct Fit {
    double start = 0.0, interval = 0.0, later = 0.0;
    double at(double frame, bool falling) const { return start + interval * frame + (falling ? later : 0.0); }
};

Fit fitted(const std::vector<LightEdge>& edges, const std::vector<double>& frames) {
    std::array<std::array<double, 4>, 3> rows{};
    const double middle = 0.5 * (frames.front() + frames.back()), origin = edges.front().time_s;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const std::array<double, 4> v{1.0, frames[i] - middle, edges[i].rising ? -0.5 : 0.5, edges[i].time_s - origin};
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 4; ++c)
                rows[r][c] += v[r] * v[c];
        }
    }
    for (std::size_t r = 0; r < 3; ++r) {  // Gauss and Jordan; the matrix is positive definite
        for (std::size_t other = 0; other < 3; ++other) {
            if (other == r) continue;
            const double factor = rows[other][r] / rows[r][r];
            for (std::size_t c = r; c < 4; ++c)
                rows[other][c] -= factor * rows[r][c];
        }
    }
    const double base = rows[0][3] / rows[0][0], interval = rows[1][3] / rows[1][1], later = rows[2][3] / rows[2][2];
    return {origin + base - interval * middle - 0.5 * later, interval, later};
}

/// How many frames after the edge before it this one is.
double framesBetween(const LightEdge& before, const LightEdge& after, double interval, double later) {
    const double bias = (after.rising ? 0.0 : later) - (before.rising ? 0.0 : later);
    return std::round((after.time_s - before.time_s - bias) / interval);
}

}  // namespace

Result<EdgePace> paceIn(const Recording& recording, std::optional<Second> interval, Second shortest) {
    auto found = edgesOf(recording.light, recording.samplesPerSecond, shortest);
    if (!found) return tl::unexpected(found.error());
    const auto few = [] {
        return fail(Fault::device,
                    "There are too few edges in the recording; let the pattern play for a second or more.");
    };
    if (found->edges.size() < kFewestForPace) return few();
    double usual = interval ? interval->si() : 0.0;
    if (!interval) {
        // Two frames at a time, so that it does not matter by how much falling edges come later.
        std::vector<double> pairs;
        for (std::size_t i = 2; i < found->edges.size(); ++i)
            pairs.push_back(0.5 * (found->edges[i].time_s - found->edges[i - 2].time_s));
        usual = spreadOf(std::move(pairs)).median.si();
    }
    if (!(usual > 0.0)) return few();
    auto edges = longestRun(found->edges, usual);
    if (edges.size() < kFewestForPace) return few();

    // By how much falling edges are later, first from the mean steps of both kinds.
    double later = 0.0, sums[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
    for (std::size_t i = 1; i < edges.size(); ++i) {
        const double step = edges[i].time_s - edges[i - 1].time_s;
        if (step > 1.9 * usual) continue;
        sums[edges[i].rising ? 1 : 0] += step;
        counts[edges[i].rising ? 1 : 0] += 1.0;
    }
    if (counts[0] > 0.0 && counts[1] > 0.0) later = 0.5 * (sums[0] / counts[0] - sums[1] / counts[1]);

    EdgePace pace;
    pace.contrast = found->contrast;
    Fit fit;
    for (int pass = 0; pass < 3; ++pass) {
        std::vector<double> frames{0.0};
        std::vector<LightEdge> kept{edges.front()};
        std::vector<std::size_t> held;
        int extra = 0;
        for (std::size_t i = 1; i < edges.size(); ++i) {
            const double steps = framesBetween(kept.back(), edges[i], usual, later);
            if (steps < 1.0) {
                ++extra;
                continue;
            }
            if (steps > 1.0) held.push_back(kept.size());
            frames.push_back(frames.back() + steps);
            kept.push_back(edges[i]);
        }
        if (kept.size() < kFewestForPace) return few();
        fit = fitted(kept, frames);
        usual = fit.interval;
        later = fit.later;
        pace.held = std::move(held);
        pace.extra = extra;
        pace.late_s.clear();
        for (std::size_t i = 0; i < kept.size(); ++i)
            pace.late_s.push_back(kept[i].time_s - fit.at(frames[i], !kept[i].rising));
        pace.edges = std::move(kept);
    }
    pace.interval = Second::fromSi(fit.interval);
    pace.fallingLater = Second::fromSi(fit.later);
    pace.late = spreadOf(pace.late_s);
    const double wrong = static_cast<double>(pace.extra) / static_cast<double>(pace.edges.size());
    const bool many = pace.edges.size() >= 30;
    pace.confidence = pace.contrast >= 20.0 && many && wrong <= 0.01  ? Confidence::good
                      : pace.contrast >= 10.0 && many && wrong <= 0.1 ? Confidence::fair
                                                                      : Confidence::poor;
    return pace;
}

}  // namespace ilf::devices
