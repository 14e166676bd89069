#include "core/track/follower.h"

#include <algorithm>
#include <cmath>

namespace ilf {

namespace {

constexpr double kRounding_s = 1e-9;  // of sums of frame times

/// Whether two sightings are of one thing that moved a little.
bool near(const Motion& a, const Motion& b, const Quad& place, const FollowLimits& limits) {
    const Quad at = moved(place, a);
    const double size = std::sqrt(std::abs(signedArea(at)));
    return farthestCorner(at, moved(place, b)) <= std::max(limits.leastJump_px, limits.jump * size);
}

/// True if the sighting counts; else it may have become, or confirmed, the candidate.
bool counts(Follower& follower, const Observation& seen, const Quad& place, const FollowLimits& limits) {
    if (!(seen.confidence >= limits.keep)) return false;
    const bool fresh = follower.seen && follower.state == FollowState::following;
    if (fresh && near(follower.motion, seen.motion, place, limits)) return true;
    if (!(seen.confidence >= limits.takeUp)) return false;
    const bool agrees = follower.candidate && seen.time - follower.candidate->time <= limits.forget &&
                        near(follower.candidate->motion, seen.motion, place, limits);
    follower.confirmed = agrees ? follower.confirmed + 1 : 1;
    follower.candidate = seen;
    return follower.confirmed >= limits.confirmations;
}

}  // namespace

const char* word(FollowState state) {
    switch (state) {
    case FollowState::following:
        return "following";
    case FollowState::holding:
        return "holding";
    case FollowState::fading:
        return "fading";
    case FollowState::lost:
        return "lost";
    }
    return "";
}

Follower followed(Follower follower, const Follow& follow, const Quad& place,
                  const std::optional<Observation>& observation, Second now, const FollowLimits& limits) {
    const Second before = follower.since.value_or(now);
    now = std::max(now, before);
    const double step_s = (now - before).si();
    if (!follower.since) follower.seen = now;  // patience begins with the first step
    follower.since = now;

    if (observation && counts(follower, *observation, place, limits)) {
        follower.state = FollowState::following;
        follower.motion = observation->motion;
        follower.confidence = std::min(1.0, observation->confidence);
        follower.seen = now;
        follower.candidate.reset();
        follower.confirmed = 0;
        follower.fade = std::max(0.0, follower.fade - step_s / limits.back.si());
        return follower;
    }

    follower.confidence = 0.0;
    const Second unseen = now - *follower.seen;
    // Only the part of this step that lies beyond the hold fades.
    const double fading_s = std::min(step_s, (unseen - follow.hold).si());
    if (fading_s > kRounding_s) {
        follower.fade = follow.fade.si() > 0.0 ? std::min(1.0, follower.fade + fading_s / follow.fade.si()) : 1.0;
        follower.state = follower.fade >= 1.0 ? FollowState::lost : FollowState::fading;
    } else if (follower.state == FollowState::following) {
        follower.state = FollowState::holding;
    }
    return follower;
}

}  // namespace ilf
