// How late a projector's light comes after its trigger, and how evenly, from a recording of edges that are known.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "devices/measure/recording.h"

namespace ilf::devices {

struct LightEdge {
    double time_s = 0.0;  ///< since the first sample, finer than a sample
    bool rising = false;
    double strength = 0.0;  ///< its steepest slope, as a share of the usual edge's of its kind
};

struct FoundEdges {
    std::vector<LightEdge> edges;  ///< in order of time; rising and falling ones alternate
    double contrast =
        0.0;  ///< the usual edge's slope (of the fainter kind) against the standard deviation of the noise's
};

/// An edge is where light changes fastest: there a slow photodiode begins to follow and an AC-coupled one does too,
/// while drift of the baseline is slow and makes none. Slopes are taken over about `shortest` / 6 (standard deviation
/// of a Gaussian), so edges nearer than `shortest` are not told apart. A photodiode with a time constant of its own
/// shows every edge later by the same: by its time constant while that is much less than `shortest` / 6, by up to 0.4
/// `shortest` when it is many times more. Refused, with the reason: nothing changes, or edges do not stand out of the
/// noise (contrast below 6).
Result<FoundEdges> edgesOf(std::span<const double> volts, double samplesPerSecond, Second shortest = 3.0_ms);

/// The usual spread of a number of times.
struct Spread {
    Second median, deviation;  ///< deviation: robust, 1.4826 times the median distance from the median
    Second low, high;          ///< 5th and 95th percentile
};
Spread spreadOf(std::vector<double> times_s);

/// How well a figure may be trusted.
enum class Confidence { good, fair, poor };
const char* word(Confidence confidence);

/// Light after trigger.
struct EdgeDelays {
    std::vector<double> delay_s;  ///< of each light edge that belongs to a trigger, in order
    Spread delay;
    /// Of the delays near the usual one. A trigger's bare edge and light's are each known to half a sample, so single
    /// delays, and their median with them, jump by whole samples; over triggers that drift along the samples, as those
    /// of a projector with a clock of its own do, that averages out. In step with the samples it never does.
    Second mean;
    /// By how much falling edges come later than rising ones; absent where only one kind is counted. `delay` is then of
    /// rising edges, and falling ones less this.
    std::optional<Second> fallingLater;
    Second triggerInterval;
    int triggers = 0, missing = 0, extra = 0;  ///< triggers without light; light without a trigger of its own
    double contrast = 0.0;
    Confidence confidence = Confidence::poor;
};
/// Both columns. One light edge is expected for each rising trigger edge: either kind where light changes at each
/// trigger (frames in turn white and black), only rising ones where each trigger begins a flash. A delay is known up to
/// whole intervals of the trigger; the one from 0 to less than an interval is told. Light that keeps still before and
/// after is left out. Refused: no trigger edges, no light edges, or light in step with no trigger.
Result<EdgeDelays> delaysIn(const Recording& recording, Second shortest = 3.0_ms);

/// Light alone, of a picture that changes each frame.
struct EdgePace {
    std::vector<LightEdge> edges;
    std::vector<double> late_s;  ///< of each edge, against even steps of `interval`, rising and falling ones apart
    Second interval;             ///< of one frame
    Spread late;
    Second fallingLater;            ///< by how much falling edges come late against rising ones
    std::vector<std::size_t> held;  ///< edges that came a whole frame or more after they should have
    int extra = 0;                  ///< edges between frames
    double contrast = 0.0;
    Confidence confidence = Confidence::poor;
};
/// `interval`: of the frames, if known; else what most edges keep. Without a trigger nobody knows the delay itself.
Result<EdgePace> paceIn(const Recording& recording, std::optional<Second> interval = {}, Second shortest = 3.0_ms);

}  // namespace ilf::devices
