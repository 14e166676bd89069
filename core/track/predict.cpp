#include "core/track/predict.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace ilf {

namespace {

using Seen = CornerTrack::Seen;

struct Fit {
    Quad middle;  ///< at the mean time
    Quad speed;   ///< pixels a second
    Second meanTime;
    double scatter = 0.0;    ///< sum of squares about the lines, px^2
    double explained = 0.0;  ///< sum of squares that the lines' slopes take away
};

Fit fitted(std::span<const Seen> seen) {
    Fit fit;
    const double n = static_cast<double>(seen.size());
    const double t0 = seen.front().time.si();
    double t = 0.0;
    for (const Seen& s : seen)
        t += (s.time.si() - t0) / n;
    double tt = 0.0;
    for (const Seen& s : seen)
        tt += std::pow(s.time.si() - t0 - t, 2);
    fit.meanTime = Second::fromSi(t0 + t);
    const auto line = [&](const auto& value, double& middle, double& speed) {
        double mean = 0.0, slope = 0.0, squares = 0.0;
        for (const Seen& s : seen)
            mean += value(s) / n;
        for (const Seen& s : seen)
            slope += (s.time.si() - t0 - t) * (value(s) - mean);
        slope = tt > 0.0 ? slope / tt : 0.0;
        for (const Seen& s : seen)
            squares += std::pow(value(s) - mean - slope * (s.time.si() - t0 - t), 2);
        middle = mean;
        speed = slope;
        fit.scatter += squares;
        fit.explained += slope * slope * tt;
    };
    for (std::size_t k = 0; k < 4; ++k) {
        line([k](const Seen& s) { return s.corners[k].x; }, fit.middle[k].x, fit.speed[k].x);
        line([k](const Seen& s) { return s.corners[k].y; }, fit.middle[k].y, fit.speed[k].y);
    }
    return fit;
}

constexpr double kDoubt = 1e-3;
/// Rounding of coordinates of some thousand pixels must not pass for scatter.
constexpr double kLeastScatter = 1e-16;

/// F for 2 and 2 (n - 2) degrees of freedom at kDoubt: (n - 2) (p^(-1/(n-2)) - 1).
double threshold(std::size_t n) {
    const double free = static_cast<double>(n) - 2.0;
    return free * (std::pow(kDoubt, -1.0 / free) - 1.0);
}

bool moves(const Fit& fit, std::size_t n) {
    if (n < 3) return false;
    const double noise = std::max(fit.scatter / (static_cast<double>(n) - 2.0), kLeastScatter);
    return fit.explained > threshold(n) * noise;
}

Quad along(const Fit& fit, Second at) {
    const double dt = (at - fit.meanTime).si();
    Quad q = fit.middle;
    for (std::size_t k = 0; k < 4; ++k) {
        q[k].x += dt * fit.speed[k].x;
        q[k].y += dt * fit.speed[k].y;
    }
    return q;
}

/// The newest sightings that one motion explains: from the three newest back to the first that is off their line.
std::span<const Seen> oneMotion(std::span<const Seen> seen) {
    constexpr double kLeaves = 4.0;          // standard deviations
    constexpr double kNeverLeaves_px = 0.1;  // what sightings scatter by in any case
    for (std::size_t n = 3; n < seen.size(); ++n) {
        const auto newer = seen.last(n);
        const Seen& older = seen[seen.size() - n - 1];
        const Fit fit = fitted(newer);
        const bool moving = moves(fit, n);
        const double count = static_cast<double>(n);
        const double noise =
            moving ? fit.scatter / (8.0 * (count - 2.0)) : (fit.scatter + fit.explained) / (8.0 * (count - 1.0));
        const Quad expected = moving ? along(fit, older.time) : fit.middle;
        double off = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
            off += std::pow(expected[k].x - older.corners[k].x, 2) + std::pow(expected[k].y - older.corners[k].y, 2);
        // A step beyond n sightings is itself only known so well.
        const double spread = moving ? 1.0 + 4.0 / count : 1.0 + 1.0 / count;
        const double most = kLeaves * kLeaves * spread * std::max(noise, kNeverLeaves_px * kNeverLeaves_px / 8.0);
        if (off > 8.0 * most) return newer;
    }
    return seen;
}

}  // namespace

CornerTrack tracked(CornerTrack track, Second time, const Quad& corners) {
    if (!track.seen.empty() && !(time > track.seen.back().time)) track.seen.clear();
    track.seen.push_back({time, corners});
    std::erase_if(track.seen, [&](const Seen& s) { return time - s.time > kTrackMemory; });
    if (track.seen.size() > kTrackLength) track.seen.erase(track.seen.begin());
    return track;
}

Quad predicted(const CornerTrack& track, Second at) {
    assert(!track.seen.empty());
    const auto seen = oneMotion(track.seen);
    const Second newest = seen.back().time;
    if (seen.size() < 3) return seen.back().corners;
    const Fit fit = fitted(seen);
    if (!moves(fit, seen.size())) return fit.middle;
    return along(fit, std::clamp(at, newest - kTrackMemory, newest + kFarthestAhead));
}

std::vector<Second> photonTimes(const Plan& plan, Second sweepStart) {
    std::vector<Second> times;
    times.reserve(plan.slots.size());
    for (const Slot& slot : plan.slots)
        times.push_back(sweepStart + slot.middle());
    return times;
}

Second meanLight(const Plan& plan) {
    const double period_s = 1.0 / plan.input.rig.sweepRate.si();
    double light = 0.0, sum_s = 0.0;
    for (const Slot& slot : plan.slots) {
        double weight = 0.0;
        for (const LevelLight& lit : slot.lit)
            weight = std::max(weight, lit.weight);
        weight *= slot.duration.si();
        light += weight;
        sum_s += weight * slot.middle().si();
    }
    return Second::fromSi(light > 0.0 ? sum_s / light : 0.5 * period_s);
}

}  // namespace ilf
