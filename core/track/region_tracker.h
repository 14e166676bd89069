// All that a document's regions follow: what is looked for in each picture, and where each region belongs by now.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/track/follower.h"
#include "core/track/planar.h"
#include "core/track/predict.h"
#include "core/track/region_move.h"

namespace ilf {

/// What is to be said of a region that follows something.
struct FollowedNow {
    RegionId region;
    FollowState state = FollowState::holding;
    double confidence = 0.0;  ///< 0..1 of the last sighting while following, else 0
    double fade = 0.0;        ///< 0: its own look, 1: its safe one
    Quad from, to;            ///< the target's corners where the region was painted, and where its light is put
    std::string trouble;      ///< why it cannot follow, in one sentence
    bool operator==(const FollowedNow&) const = default;
};

/// Where something is, as another program says.
struct StreamPose {
    double x = 0.0, y = 0.0;    ///< of the picture's width and height, y down
    double rotation_deg = 0.0;  ///< clockwise in the picture
    double confidence = 1.0;
};

/// A target that stands still is taken to stand where its light is as long as it is seen no farther off than this: less
/// than a good registration knows (0.2 px rms and a feather of many pixels), and more than sightings scatter by once
/// they are averaged, so that noise costs no compile and no light changes.
inline constexpr double kStill_px = 0.25;
/// A target of which neither picture nor pose came for so long counts as not seen; longer where pictures come slowly.
inline constexpr Second kSilence = 250.0_ms;

struct FollowBy {
    bool camera = true, stream = true;
    bool operator==(const FollowBy&) const = default;
};

/// Not a value: one thread at a time feeds it in the order of time. What it says depends on nothing else.
class RegionTracker {
public:
    /// Takes over what the document's regions follow. Targets are learnt in the scene's picture, where the regions were
    /// painted; a region whose target and picture are the same as before goes on. Some 40 ms for each new marker of a
    /// picture of 1280 x 720.
    /// `by`: what there is to follow with; regions that follow something else are not among those followed.
    void follow(const Document& document, FollowBy by = {});
    bool follows() const { return !all_.empty(); }
    bool looks() const;    ///< some follow what is seen
    bool listens() const;  ///< some follow what is sent

    /// One channel of the camera's picture; `exposed`: the middle of its exposure; `now`: when it is looked at.
    void see(const Image<std::uint8_t>& grey, Second exposed, Second now);
    /// `time`: when it was true.
    void hear(const std::string& address, const StreamPose& pose, Second time, Second now);
    /// Time passes: patience with what was silent for kSilence runs.
    void pass(Second now);
    /// True while time alone changes something: not all are lost.
    bool patient() const;

    /// For light of a sweep that begins at `sweepStart` and lasts `period`. What stands still is given as before.
    std::vector<RegionMove> moves(Second sweepStart, Second period);
    std::vector<FollowedNow> now() const;

private:
    struct Followed {
        RegionId id;
        Follow follow;
        Quad from{};
        std::string trouble;
        std::optional<Box<PlanarPattern>> pattern;
        Follower follower;
        CornerTrack track;
        Quad now{}, speed{};          ///< as last given
        std::optional<Second> asked;  ///< when it last could have been seen
        PlanarSearch search;          ///< for a flat target
        bool inVain = false;          ///< it was not where it was expected in the last picture
    };
    std::optional<Quad> expected(const Followed& one, Second at) const;  ///< where to look first
    Second patience(Second usual) const;                                 ///< or some pictures' time
    void learn(Followed& one, const Document& document, const Region& region);
    void step(Followed& one, const std::optional<Observation>& seen, Second now);
    void seeMarkers(const Image<std::uint8_t>& grey, Second exposed, Second now);
    void seePlanar(Followed& one, const Image<std::uint8_t>& grey, Second exposed, Second now);

    std::vector<Followed> all_;
    Box<Picture> learntFrom_;
    Image<std::uint8_t> learntGrey_;
    Size picture_;
    Size camera_;         ///< of what was seen last
    int wholeLooks_ = 0;  ///< for markers
    std::optional<Second> lastLook_;
    Second between_ = 33.3_ms;  ///< pictures
};

}  // namespace ilf
