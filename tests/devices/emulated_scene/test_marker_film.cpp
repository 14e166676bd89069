// The emulated scene's moving marker, followed end to end against where it truly is.
#include "devices/emulated_scene/marker_film.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/grey.h"
#include "core/track/region_tracker.h"
#include "devices/camera/camera.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

constexpr Second kFrame = Second::fromSi(1.0 / 30.0), kSweep = Second::fromSi(1.0 / 60.0);
/// From the middle of the exposure to the middle of the sweep that shows it (scheduling.md 10).
constexpr Second kAhead = 63.0_ms;

std::unique_ptr<MarkerFilm> filmOf(const char* words) {
    auto film = MarkerFilm::of(*sceneWishFrom(words));
    REQUIRE_MESSAGE(film, film.error().what);
    return *std::move(film);
}

Document following(const Frame& first, int id, Follow::WhenLost lost) {
    Document document;
    document.scene.picture = Box(asPicture(first));
    Region region;
    region.id = "a";
    region.look = lost == Follow::WhenLost::blur ? Look::blur : Look::focus;
    region.mask = Mask(document.scene.size());
    region.follow = Follow{MarkerTarget{"APRILTAG_36h11", id}, lost};
    document.regions = {Box(region)};
    return document;
}

struct Errors {
    double squares = 0.0, worst = 0.0;
    int count = 0;
    void add(double v) {
        squares += v * v;
        worst = std::max(worst, v);
        ++count;
    }
    double rms() const { return std::sqrt(squares / count); }
};

}  // namespace

TEST_CASE("a marker that goes round is followed within half a pixel, and its light within two") {
    const auto film = filmOf("marker=7,lap=6,binning=2,ambient=60");
    RegionTracker tracker;
    tracker.follow(following(film->at(0.0_s, 1), 7, Follow::WhenLost::neutral));
    REQUIRE(tracker.now().at(0).trouble.empty());
    Errors seen, lit, unpredicted;
    for (int i = 1; i <= 45; ++i) {
        const Second t = static_cast<double>(i) * kFrame;
        tracker.see(greyOf(film->at(t, static_cast<std::uint64_t>(i) + 1).rgb), t, t + 25.0_ms);
        if (i < 8) continue;  // until the track has its length
        CHECK(tracker.now()[0].state == FollowState::following);
        const auto off = [&](const RegionMove& move, Second into, Second at) {
            return farthestCorner(moved(film->truth(0.0_s), motionAt(move, into).motion), film->truth(at));
        };
        RegionTracker then = tracker;
        const auto now = then.moves(t, kSweep).at(0);
        seen.add(off(now, 0.0_s, t));
        unpredicted.add(off(now, 0.0_s, t + kAhead));
        const auto move = tracker.moves(t + kAhead - 0.5 * kSweep, kSweep).at(0);
        lit.add(off(move, 0.5 * kSweep, t + kAhead));
    }
    MESSAGE("off the truth: seen ", seen.rms(), " px rms, ", seen.worst, " worst; ", kAhead.si() * 1e3, " ms ahead ",
            lit.rms(), " rms, ", lit.worst, " worst; unpredicted ", unpredicted.rms(), " rms");
    // The exposure smears 8 ms of up to 100 mm/s (1 px here) evenly to both sides, and eight sightings on a curve are
    // taken for a line: r (2 pi / 6 s)^2 = 110 mm/s^2, of which half over (117 ms)^2 is 0.8 mm or 1 px between its
    // ends.
    CHECK(seen.rms() < 0.5);
    // A line goes on straight while the way bends: 1/2 a t^2 with the line's mean age, 117 + 63 ms, is 1.8 mm or 2 px.
    CHECK(lit.rms() < 2.0);
    CHECK(lit.worst < 3.0);
    CHECK(lit.rms() < 0.5 * unpredicted.rms());
}

TEST_CASE("a covered marker: the region holds, fades and is lost, and comes back when it is uncovered") {
    const auto film = filmOf("marker=3,lap=12,cover=0.6:2.2,binning=4,ambient=60");
    for (const auto lost : {Follow::WhenLost::blur, Follow::WhenLost::neutral}) {
        const Document document = following(film->at(0.0_s, 1), 3, lost);
        RegionTracker tracker;
        tracker.follow(document);
        FollowState at1s{}, at1_4s{}, at2s{};
        for (int i = 1; i <= 96; ++i) {
            const Second t = static_cast<double>(i) * kFrame;
            tracker.see(greyOf(film->at(t, static_cast<std::uint64_t>(i) + 1).rgb), t, t);
            const FollowState state = tracker.now()[0].state;
            if (i == 15) CHECK(state == FollowState::following);
            if (i == 30) at1s = state;
            if (i == 42) at1_4s = state;
            if (i == 60) at2s = state;
            const auto shown = moved(document, motionsAt(tracker.moves(t, kSweep), 0.0_s));
            if (lost == Follow::WhenLost::blur) CHECK(shown.regions[0]->look == Look::blur);
            if (lost == Follow::WhenLost::neutral && state == FollowState::lost)
                CHECK(shown.regions[0]->look == Look::neutral);
        }
        CHECK(at1s == FollowState::holding);
        CHECK(at1_4s == FollowState::fading);
        CHECK(at2s == FollowState::lost);
        CHECK(tracker.now()[0].state == FollowState::following);
    }
}

TEST_CASE("a marker is asked for in words, and a film without one is refused") {
    CHECK(sceneWishFrom("marker=9,lap=4,cover=2:3.5")->coveredTo_s == 3.5);
    CHECK(sceneWishFrom(wordsOf(*sceneWishFrom("marker=9,lap=4,cover=2:3.5"))) ==
          sceneWishFrom("marker=9,lap=4,cover=2:3.5"));
    CHECK_FALSE(sceneWishFrom("marker=10"));
    CHECK_FALSE(sceneWishFrom("cover=3:2"));
    CHECK(MarkerFilm::of(SceneWish{}).error().what.find("marker=0 to 9") != std::string::npos);
}
