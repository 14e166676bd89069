#include "core/track/region_tracker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/grey.h"
#include "core/track/marker.h"

namespace ilf {

namespace {

/// A camera that gives few pictures is silent, and forgets, only after so many of its pauses; a slower one is none.
constexpr double kFewPictures = 2.5;
constexpr Second kSlowest = 1.0_s;
/// Pictures that come so seldom leave time for all looks of a search at once, some 15 ms.
constexpr Second kSeldom = 90.0_ms;
/// Around where a marker is predicted: half its size, for what hands do between frames, but so much at least.
constexpr int kLeastMargin_px = 32;

/// Clockwise by `degrees` about `middle`, a square of half `half`.
Quad turnedSquare(Point<CameraFrame> middle, double half, double degrees) {
    const double a = degrees * std::numbers::pi / 180.0, c = half * std::cos(a), s = half * std::sin(a);
    return {{{middle.x - c + s, middle.y - s - c},
             {middle.x + c + s, middle.y + s - c},
             {middle.x + c - s, middle.y + s + c},
             {middle.x - c - s, middle.y - s + c}}};
}

double halfSize(const Quad& quad) { return 0.5 * std::sqrt(std::abs(signedArea(quad))); }

/// Of several with one number: the one that is nearest to where it should be, or the surest.
const SeenMarker* chosen(const std::vector<SeenMarker>& seen, int id, const std::optional<Quad>& expected) {
    const SeenMarker* best = nullptr;
    const auto worse = [&](const SeenMarker& a, const SeenMarker& b) {
        return expected ? farthestCorner(a.corners, *expected) > farthestCorner(b.corners, *expected)
                        : a.confidence < b.confidence;
    };
    for (const SeenMarker& marker : seen) {
        if (marker.id == id && (best == nullptr || worse(*best, marker))) best = &marker;
    }
    return best;
}

std::string nameOf(const MarkerTarget& marker) { return marker.dictionary + " number " + std::to_string(marker.id); }

}  // namespace

Second RegionTracker::patience(Second usual) const { return std::max(usual, kFewPictures * between_); }

std::optional<Quad> RegionTracker::expected(const Followed& one, Second at) const {
    const auto& candidate = one.follower.candidate;
    const CornerTrack& track = one.track;
    if (candidate && at - candidate->time <= patience(FollowLimits{}.forget)) return moved(one.from, candidate->motion);
    if (!track.seen.empty() && at - track.seen.back().time <= patience(kTrackMemory)) return predicted(track, at);
    // Where it was painted, before it was ever seen.
    return track.seen.empty() ? std::optional(one.from) : std::nullopt;
}

bool RegionTracker::looks() const {
    return std::ranges::any_of(
        all_, [](const Followed& one) { return !std::holds_alternative<StreamTarget>(one.follow.target); });
}

bool RegionTracker::listens() const {
    return std::ranges::any_of(
        all_, [](const Followed& one) { return std::holds_alternative<StreamTarget>(one.follow.target); });
}

bool RegionTracker::patient() const {
    return std::ranges::any_of(
        all_, [](const Followed& one) { return one.trouble.empty() && one.follower.state != FollowState::lost; });
}

void RegionTracker::follow(const Document& document, FollowBy by) {
    const bool samePicture = document.scene.picture.same(learntFrom_);
    picture_ = document.scene.size();
    if (!by.camera) camera_ = {};
    std::vector<Followed> next;
    for (const Box<Region>& region : document.regions) {
        if (!region->follow) continue;
        const bool stream = std::holds_alternative<StreamTarget>(region->follow->target);
        if (stream ? !by.stream : !by.camera) continue;
        const auto before = std::ranges::find(all_, region->id, &Followed::id);
        const bool known = before != all_.end() && samePicture && before->follow.target == region->follow->target;
        Followed one = known ? *before : Followed{};
        one.id = region->id;
        one.follow = *region->follow;
        // Where the region of a pose stream was painted is its middle, which moves with every stroke.
        if (!known || stream) learn(one, document, *region);
        next.push_back(std::move(one));
    }
    all_ = std::move(next);
    learntFrom_ = document.scene.picture;
    learntGrey_ = {};
}

void RegionTracker::learn(Followed& one, const Document& document, const Region& region) {
    one.trouble.clear();
    if (std::holds_alternative<StreamTarget>(one.follow.target)) {
        const auto covered = region.mask.empty() ? PixelRect<CameraFrame>{} : region.mask.coveredPixels();
        const Quad from = turnedSquare(middleOf(region.mask), std::max(8.0, halfSize(cornersOf(covered))), 0.0);
        if (from == one.from) return;
        // A stroke moves the middle of what is painted: the region stays where it is until the next pose.
        const auto along = [&](const Quad& seen) {
            const auto motion = motionBetween(one.from, seen);
            return motion ? moved(from, *motion) : from;
        };
        one.now = along(one.now);
        for (CornerTrack::Seen& seen : one.track.seen)
            seen.corners = along(seen.corners);
        one.from = from;
        return;
    }
    if (!document.scene.picture) {
        one.trouble = "There is no scene's picture to learn it from: grab one (F5).";
        return;
    }
    if (learntGrey_.empty()) learntGrey_ = greyOf(*document.scene.picture);
    if (const auto* marker = std::get_if<MarkerTarget>(&one.follow.target)) {
        const auto seen = findMarkers(learntGrey_, {marker->dictionary, {marker->id}, {}, 1});
        const SeenMarker* there = seen ? chosen(*seen, marker->id, std::nullopt) : nullptr;
        if (!seen) {
            one.trouble = seen.error().what;
        } else if (there == nullptr) {
            one.trouble = "Marker " + nameOf(*marker) +
                          " is not in the scene's picture, so where the region lies on it is not known: grab a picture "
                          "that shows it (F5).";
        } else {
            one.from = there->corners;
        }
    } else {
        auto pattern = planarPattern(learntGrey_, std::get<PlanarTarget>(one.follow.target).patch);
        if (!pattern) {
            one.trouble = pattern.error().what;
        } else {
            one.from = cornersOf((*pattern)->patch);
            one.pattern = *std::move(pattern);
        }
    }
    one.now = one.from;
}

void RegionTracker::step(Followed& one, const std::optional<Observation>& seen, Second now) {
    one.asked = now;
    FollowLimits limits;
    limits.forget = patience(limits.forget);
    one.follower = followed(one.follower, one.follow, one.from, seen, now, limits);
    if (!seen || one.follower.state != FollowState::following || !(one.follower.motion == seen->motion)) return;
    one.track = tracked(std::move(one.track), seen->time, moved(one.from, seen->motion));
}

void RegionTracker::see(const Image<std::uint8_t>& grey, Second exposed, Second now) {
    camera_ = grey.size();
    if (camera_ != picture_) return pass(now);
    if (lastLook_) between_ = 0.7 * between_ + 0.3 * std::clamp(now - *lastLook_, 0.0_s, kSlowest);
    lastLook_ = now;
    seeMarkers(grey, exposed, now);
    for (Followed& one : all_) {
        if (one.pattern && one.trouble.empty()) seePlanar(one, grey, exposed, now);
    }
    pass(now);
}

void RegionTracker::seeMarkers(const Image<std::uint8_t>& grey, Second exposed, Second now) {
    struct Wanted {
        Followed* one;
        const MarkerTarget* marker;
        std::optional<Quad> expected;
        std::optional<SeenMarker> seen;
    };
    std::vector<Wanted> wanted;
    std::map<std::string, std::vector<int>> missing;
    for (Followed& one : all_) {
        const auto* marker = std::get_if<MarkerTarget>(&one.follow.target);
        if (marker == nullptr || !one.trouble.empty()) continue;
        Wanted want{&one, marker, {}, {}};
        want.expected = expected(one, exposed);
        if (want.expected) {
            const int margin = std::max(kLeastMargin_px, static_cast<int>(halfSize(*want.expected)));
            const auto found =
                findMarkers(grey, {marker->dictionary, {marker->id}, boxAround(*want.expected).grown(margin), 1});
            const SeenMarker* there = found ? chosen(*found, marker->id, want.expected) : nullptr;
            if (there != nullptr) want.seen = *there;
        }
        if (!want.seen) missing[marker->dictionary].push_back(marker->id);
        wanted.push_back(std::move(want));
    }
    if (!missing.empty()) {
        const int look = wholeLooks_++;
        for (const auto& [dictionary, ids] : missing) {
            const auto found = findMarkers(grey, partOfSearch({dictionary, ids, {}, 1}, grey.size(), look));
            if (!found) continue;
            for (Wanted& want : wanted) {
                if (want.seen || want.marker->dictionary != dictionary) continue;
                const SeenMarker* there = chosen(*found, want.marker->id, want.expected);
                if (there != nullptr) want.seen = *there;
            }
        }
    }
    for (const Wanted& want : wanted) {
        std::optional<Observation> seen;
        if (want.seen) {
            if (const auto motion = motionBetween(want.one->from, want.seen->corners))
                seen = Observation{exposed, *motion, want.seen->confidence};
        }
        step(*want.one, seen, now);
    }
}

void RegionTracker::seePlanar(Followed& one, const Image<std::uint8_t>& grey, Second exposed, Second now) {
    // A picture in which it was not where it was expected is not searched too, which would take too long: the next is.
    const auto quad = one.inVain ? std::nullopt : expected(one, exposed);
    const auto near = quad ? motionBetween(one.from, *quad) : std::nullopt;
    const int looks = near ? 0 : between_ < kSeldom ? 1 : PlanarSearch::kLooks;
    auto found = near ? followPlanar(**one.pattern, grey, *near) : std::nullopt;
    for (int i = 0; i < looks && !found; ++i)
        found = lookedFor(one.search, **one.pattern, grey);
    one.inVain = near && !found;
    if (found) one.search = {};
    step(one, found ? std::optional(Observation{exposed, found->motion, found->confidence}) : std::nullopt, now);
}

void RegionTracker::hear(const std::string& address, const StreamPose& pose, Second time, Second now) {
    for (Followed& one : all_) {
        const auto* stream = std::get_if<StreamTarget>(&one.follow.target);
        if (stream == nullptr || stream->address != address) continue;
        const Point<CameraFrame> middle{pose.x * picture_.width, pose.y * picture_.height};
        const auto motion = motionBetween(one.from, turnedSquare(middle, halfSize(one.from), pose.rotation_deg));
        step(one, motion ? std::optional(Observation{time, *motion, pose.confidence}) : std::nullopt, now);
    }
    pass(now);
}

void RegionTracker::pass(Second now) {
    for (Followed& one : all_) {
        if (!one.trouble.empty()) continue;
        if (!one.asked) one.asked = now;
        if (now - *one.asked < patience(kSilence) && one.follower.since) continue;
        const Second asked = *one.asked;
        step(one, std::nullopt, now);
        one.asked = asked;
    }
}

std::vector<RegionMove> RegionTracker::moves(Second sweepStart, Second period) {
    std::vector<RegionMove> moves;
    for (Followed& one : all_) {
        if (!one.trouble.empty()) continue;
        if (one.follower.state != FollowState::following || one.track.seen.empty()) {
            one.speed = {};  // it stays where its light was last
        } else {
            const Quad at = predicted(one.track, sweepStart), later = predicted(one.track, sweepStart + period);
            Quad speed{};
            for (std::size_t k = 0; k < at.size(); ++k)
                speed[k] = {(later[k].x - at[k].x) / period.si(), (later[k].y - at[k].y) / period.si()};
            const bool still = speed == Quad{} && one.speed == Quad{} && farthestCorner(at, one.now) < kStill_px;
            if (!still) {
                one.now = at;
                one.speed = speed;
            }
        }
        moves.push_back({one.id, one.from, one.now, one.speed, one.follower.fade});
    }
    return moves;
}

std::vector<FollowedNow> RegionTracker::now() const {
    const auto pixels = [](Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); };
    std::vector<FollowedNow> said;
    for (const Followed& one : all_) {
        said.push_back(
            {one.id, one.follower.state, one.follower.confidence, one.follower.fade, one.from, one.now, one.trouble});
        const bool stream = std::holds_alternative<StreamTarget>(one.follow.target);
        if (stream || camera_ == Size{} || camera_ == picture_) continue;
        said.back().trouble = "The camera's pictures have " + pixels(camera_) + " pixels and the scene's " +
                              pixels(picture_) + ": grab one of this camera (F5).";
    }
    return said;
}

}  // namespace ilf
