// Where a region is that follows something: what was seen, what is done when nothing is, as a value.
#pragma once

#include <optional>

#include "core/base/quantity.h"
#include "core/document/follow.h"
#include "core/track/quad.h"

namespace ilf {

/// What was seen of a region's target.
struct Observation {
    Second time;    ///< the middle of the exposure
    Motion motion;  ///< from where it was painted to where it was then
    double confidence = 0.0;
    bool operator==(const Observation&) const = default;
};

enum class FollowState {
    following,  ///< seen
    holding,    ///< not seen for less than `hold`: stays where it was
    fading,     ///< changes to its own safe look
    lost,       ///< has it
};
const char* word(FollowState state);

/// Hysteresis and patience of all followers.
struct FollowLimits {
    double takeUp = 0.6;    ///< confidence that begins following
    double keep = 0.3;      ///< and that keeps it up
    int confirmations = 2;  ///< sightings in a row, where the last ones say it is, that begin it
    double jump =
        1.0;  ///< a step from one sighting to the next of more than this share of its size must be confirmed too
    double leastJump_px = 24.0;
    Second forget = 0.25_s;  ///< sightings farther apart than this confirm nothing
    Second back = 0.2_s;     ///< the look comes back within this time (operators.md 4: avoid steps of 5-20 Hz)
};

/// Follows one region. A new one holds where the region was painted.
struct Follower {
    FollowState state = FollowState::holding;
    Motion motion;                         ///< of the last sighting that counted
    double confidence = 0.0;               ///< of the last sighting while following, else 0
    double fade = 0.0;                     ///< 0: its own look; 1: that of Follow::whenLost
    std::optional<Second> seen;            ///< when it last counted
    std::optional<Second> since;           ///< of the last step; absent: none yet
    std::optional<Observation> candidate;  ///< seen, and not confirmed yet
    int confirmed = 0;                     ///< sightings in a row that agree with it
    bool operator==(const Follower&) const = default;
};

/// The follower after what was seen, or nothing, at `now`. `place`: where the region was painted, for the size of
/// steps. Laws: fade never jumps (it goes up within Follow::fade and back within FollowLimits::back); without sightings
/// it goes from holding through fading to lost and nowhere else; a sighting below `keep` never moves it; time that goes
/// backwards is taken as standing still.
Follower followed(Follower follower, const Follow& follow, const Quad& place,
                  const std::optional<Observation>& observation, Second now, const FollowLimits& limits = {});

}  // namespace ilf
