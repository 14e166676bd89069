#include "devices/measure/edge_delay.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "devices/usb1208/edge_finder.h"

namespace ilf::devices {
namespace {

constexpr std::size_t kFewestEdges = 8;
// Of the delays' unit phasors: below this, light comes at any time after its trigger.
constexpr double kInStep = 0.5;

double medianOf(std::vector<double> values) { return spreadOf(std::move(values)).median.si(); }

Confidence confidenceOf(double contrast, std::size_t counted, int wrong) {
    const double share = static_cast<double>(wrong) / static_cast<double>(std::max<std::size_t>(counted, 1));
    if (contrast >= 20.0 && counted >= 30 && share <= 0.01) return Confidence::good;
    if (contrast >= 10.0 && counted >= kFewestEdges && share <= 0.1) return Confidence::fair;
    return Confidence::poor;
}

Result<std::vector<double>> triggersIn(const Recording& recording) {
    if (recording.trigger.empty())
        return fail(Fault::notFound, "The recording has no trigger beside the light, so no delay can be read from it.");
    const auto [low, high] = std::minmax_element(recording.trigger.begin(), recording.trigger.end());
    const double range = *high - *low;
    EdgeFinder finder(EdgeLevels{Volt::fromSi(*low + 0.3 * range), Volt::fromSi(*low + 0.7 * range), true});
    auto edges = range > 0.0 ? finder.found(recording.trigger) : std::vector<double>();
    if (edges.size() < kFewestEdges)
        return fail(Fault::device, "The recording holds " + std::to_string(edges.size()) +
                                       " trigger edges, too few to measure a delay. Check the trigger's wire.");
    for (double& edge : edges)
        edge /= recording.samplesPerSecond;
    return edges;
}

double usualInterval(const std::vector<double>& times) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < times.size(); ++i)
        intervals.push_back(times[i] - times[i - 1]);
    return medianOf(std::move(intervals));
}

/// Where in the interval after its trigger light usually comes, as a share of it in 0..1; absent: in step with none.
std::optional<double> usualPhase(const std::vector<double>& triggers, const std::vector<LightEdge>& edges,
                                 double interval) {
    std::complex<double> sum;
    double counted = 0.0;
    for (const LightEdge& edge : edges) {
        const auto next = std::upper_bound(triggers.begin(), triggers.end(), edge.time_s);
        if (next == triggers.begin()) continue;
        const double since = edge.time_s - *std::prev(next);
        if (since > 2.0 * interval) continue;
        sum += std::polar(1.0, 2.0 * std::numbers::pi * since / interval);
        counted += 1.0;
    }
    if (counted < static_cast<double>(kFewestEdges) || std::abs(sum) < kInStep * counted) return std::nullopt;
    const double phase = std::arg(sum) / (2.0 * std::numbers::pi);
    return phase - std::floor(phase);
}

/// Which edges count: all where light changes at each trigger, the rising ones of flashes.
std::vector<LightEdge> counted(const std::vector<LightEdge>& all, const std::vector<double>& triggers,
                               double interval) {
    std::vector<LightEdge> rising, any;
    for (const LightEdge& edge : all) {
        if (edge.time_s < triggers.front() || edge.time_s > triggers.back() + 2.0 * interval) continue;
        any.push_back(edge);
        if (edge.rising) rising.push_back(edge);
    }
    if (any.empty()) return any;
    const double frames = (any.back().time_s - any.front().time_s) / interval;
    return static_cast<double>(rising.size()) > 0.75 * frames ? rising : any;
}

/// Of those nearer to the median than one sample, or than usual delays scatter: what is farther off is no measurement.
Second meanNear(const std::vector<double>& delays, const Spread& spread, double sample_s) {
    const double near = std::max(1.5 * sample_s, 3.0 * spread.deviation.si());
    double sum = 0.0, counted = 0.0;
    for (const double delay : delays) {
        if (std::abs(delay - spread.median.si()) > near) continue;
        sum += delay;
        counted += 1.0;
    }
    return counted > 0.0 ? Second::fromSi(sum / counted) : spread.median;
}

double medianDelay(const std::vector<LightEdge>& edges, const std::vector<double>& delays, bool rising) {
    std::vector<double> ofKind;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].rising == rising) ofKind.push_back(delays[i]);
    }
    return ofKind.empty() ? NAN : medianOf(std::move(ofKind));
}

}  // namespace

const char* word(Confidence confidence) {
    switch (confidence) {
    case Confidence::good:
        return "good";
    case Confidence::fair:
        return "fair";
    case Confidence::poor:
        return "poor";
    }
    return "poor";
}

Result<EdgeDelays> delaysIn(const Recording& recording, Second shortest) {
    const auto triggers = triggersIn(recording);
    if (!triggers) return tl::unexpected(triggers.error());
    const auto found = edgesOf(recording.light, recording.samplesPerSecond, shortest);
    if (!found) return tl::unexpected(found.error());
    const double interval = usualInterval(*triggers);
    const auto edges = counted(found->edges, *triggers, interval);
    const auto phase = usualPhase(*triggers, edges, interval);
    if (!phase)
        return fail(
            Fault::device,
            "The light is in step with no trigger. Check that the photodiode sees the projector whose trigger is "
            "recorded, and nothing else that flickers.");
    const double usual = *phase * interval;

    EdgeDelays delays;
    delays.triggerInterval = Second::fromSi(interval);
    delays.contrast = found->contrast;
    std::vector<LightEdge> kept;
    std::optional<std::size_t> first, last;
    for (const LightEdge& edge : edges) {
        // The trigger whose light would be the nearest.
        const auto after = std::lower_bound(triggers->begin(), triggers->end(), edge.time_s - usual);
        auto mine = after;
        if (after == triggers->end() ||
            (after != triggers->begin() && edge.time_s - usual - *std::prev(after) < *after - (edge.time_s - usual)))
            mine = std::prev(after);
        const auto index = static_cast<std::size_t>(mine - triggers->begin());
        const double delay = edge.time_s - *mine;
        if (std::abs(delay - usual) > 0.5 * interval || (last && index == *last)) {
            ++delays.extra;
            continue;
        }
        if (!first) first = index;
        if (last) delays.missing += static_cast<int>(index - *last) - 1;
        last = index;
        kept.push_back(edge);
        delays.delay_s.push_back(delay);
    }
    if (kept.size() < kFewestEdges)
        return fail(Fault::device, "Too few triggers have light of their own to tell a delay.");
    delays.triggers = static_cast<int>(*last - *first) + 1;
    const double falling = medianDelay(kept, delays.delay_s, false), rising = medianDelay(kept, delays.delay_s, true);
    if (std::isfinite(falling) && std::isfinite(rising)) {
        delays.fallingLater = Second::fromSi(falling - rising);
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (!kept[i].rising) delays.delay_s[i] -= falling - rising;
        }
    }
    delays.delay = spreadOf(delays.delay_s);
    delays.mean = meanNear(delays.delay_s, delays.delay, 1.0 / recording.samplesPerSecond);
    delays.confidence = confidenceOf(delays.contrast, kept.size(), delays.missing + delays.extra);
    return delays;
}

}  // namespace ilf::devices
