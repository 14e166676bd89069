// Where something that was seen a moment ago will be when the light falls.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/quantity.h"
#include "core/plan/plan.h"
#include "core/track/quad.h"

namespace ilf {

/// The newest sightings of four corners.
struct CornerTrack {
    struct Seen {
        Second time;  ///< the middle of the exposure
        Quad corners;
        bool operator==(const Seen&) const = default;
    };
    std::vector<Seen> seen;  ///< oldest first, times ascending
    bool operator==(const CornerTrack&) const = default;
};

/// At most so many sightings count, and none older than this before the newest: motion is only so constant.
inline constexpr std::size_t kTrackLength = 8;
inline constexpr Second kTrackMemory = 0.35_s;
/// Nothing is predicted farther ahead: a hand may stop at any time.
inline constexpr Second kFarthestAhead = 100.0_ms;

/// With one more sighting. One that is not newer than the last begins the track anew.
CornerTrack tracked(CornerTrack track, Second time, const Quad& corners);

/// Where the corners will be. A line is fitted to each coordinate over time; what it says is believed only as far as
/// the sightings' own scatter about it allows (F test at 1e-3 with the two degrees of freedom of a shift): else the
/// thing stands still, and stands at the mean of where it was seen. Sightings from before the motion changed
/// do not count. Laws: from three sightings on constant motion is predicted exactly; of
/// a thing that stands still the prediction scatters no more than the sightings do. Precondition: not empty.
Quad predicted(const CornerTrack& track, Second at);

/// How the light of a program lies in time against the camera's pictures.
struct LightTiming {
    Second exposure = 16.7_ms;  ///< of the camera's picture
    Second readout = 16.7_ms;   ///< from its end until the picture is there
    Second ahead = 30.0_ms;     ///< from then until the first sweep that can show what was made of it
};

/// When a picture that arrived then was lit, on the mean.
inline Second exposureMiddle(Second arrived, const LightTiming& timing) {
    return arrived - timing.readout - 0.5 * timing.exposure;
}
/// When each slot's light falls, in the sweep that begins at `sweepStart`: the slots' middles (plan.h).
std::vector<Second> photonTimes(const Plan& plan, Second sweepStart);
/// When the light of a whole sweep falls on the mean, counted from its start, each slot by its light; the sweep's
/// middle when none is lit. One program shows one scene in all its slots, so this is the time it is made for.
Second meanLight(const Plan& plan);

}  // namespace ilf
