// Regions of a document that follow a drawn marker, a texture or poses: where they are put, and what becomes of them
// when the target is covered.
#include "core/track/region_tracker.h"

#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/document/shape.h"
#include "tests/core/track/drawn_marker.h"

namespace ilf {

namespace {

constexpr Size kSize{640, 360};
constexpr Second kFrame = 40.0_ms, kSweep = Second::fromSi(1.0 / 60.0);

Quad squareAt(double x, double y) { return {{{x, y}, {x + 60, y}, {x + 60, y + 60}, {x, y + 60}}}; }

Image<std::uint8_t> pictureWith(const Quad& marker, unsigned seed = 1) {
    DrawnScene scene;
    scene.size = kSize;
    scene.noise = 2.0;
    scene.seed = seed;
    return drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 7, marker);
}

Picture sceneOf(const Image<std::uint8_t>& grey) {
    std::vector<std::uint16_t> rgb;
    for (const std::uint8_t v : grey.pixels())
        rgb.insert(rgb.end(), 3, static_cast<std::uint16_t>(257 * v));
    return {grey.size(), 3, std::move(rgb)};
}

Document following(const Follow& follow, Look look, const Image<std::uint8_t>& grey) {
    Document document;
    document.scene.picture = Box(sceneOf(grey));
    Region region;
    region.id = "a";
    region.look = look;
    region.mask = rasterised(Rectangle{{300, 150}, {380, 230}}, kSize);
    region.follow = follow;
    document.regions = {Box(region)};
    return document;
}

Follow marker(Follow::WhenLost lost = Follow::WhenLost::neutral) {
    Follow follow;
    follow.target = MarkerTarget{"APRILTAG_36h11", 7};
    follow.whenLost = lost;
    return follow;
}

/// Pictures at 25 Hz of a marker that was learnt at (300, 150).
struct Run {
    Document document;
    RegionTracker tracker;
    Second now = 10.0_s;
    unsigned seed = 1;

    explicit Run(const Document& of) : document(of) { tracker.follow(document); }
    void see(const Image<std::uint8_t>& grey) {
        now += kFrame;
        tracker.see(grey, now - 20.0_ms, now);
    }
    void see(const Quad& marker) { see(pictureWith(marker, ++seed)); }
    void cover(int frames) {
        for (int i = 0; i < frames; ++i)
            see(pictureWith(squareAt(-500, -500), ++seed));
    }
    RegionMove move(Second ahead = 0.0_s) { return tracker.moves(now - 20.0_ms + ahead, kSweep).at(0); }
    FollowState state() const { return tracker.now().at(0).state; }
    Document shown() { return moved(document, motionsAt(tracker.moves(now, kSweep), 0.0_s)); }
};

}  // namespace

TEST_CASE("a region follows its marker to a tenth of a pixel, and is put where it will be") {
    Run run(following(marker(), Look::focus, pictureWith(squareAt(300, 150))));
    double x = 300.0;
    for (int i = 0; i < 10; ++i)
        run.see(squareAt(x += 4.0, 150));
    CHECK(run.state() == FollowState::following);
    // 100 px/s. Corners of the drawn markers are found to 0.03 px rms; a speed from 8 of them 40 ms apart is then known
    // to 0.12 px/s, and what it says 60 ms ahead to about that of a single sighting.
    for (const Second ahead : {0.0_s, 60.0_ms}) {
        const Quad truth = squareAt(x + 100.0 * ahead.si(), 150);
        CHECK(farthestCorner(moved(squareAt(300, 150), motionAt(run.move(ahead), 0.0_s).motion), truth) < 0.25);
        const Quad later = squareAt(x + 100.0 * (ahead.si() + 0.010), 150);
        CHECK(farthestCorner(moved(squareAt(300, 150), motionAt(run.move(ahead), 10.0_ms).motion), later) < 0.25);
    }
}

TEST_CASE("a target that stands still gives the same move again and again: no compile, no light changes") {
    Run run(following(marker(), Look::focus, pictureWith(squareAt(300, 150))));
    for (int i = 0; i < 5; ++i)
        run.see(squareAt(310, 155));
    const RegionMove before = run.move(60.0_ms);
    CHECK(farthestCorner(before.now, squareAt(310, 155)) < 0.2);
    for (int i = 0; i < 15; ++i) {
        run.see(squareAt(310, 155));
        CHECK(run.move(60.0_ms) == before);
    }
}

TEST_CASE("three pictures a second are enough to follow by") {
    Run run(following(marker(), Look::focus, pictureWith(squareAt(300, 150))));
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 6; ++k)
            run.tracker.pass(run.now += 50.0_ms);
        run.see(squareAt(300 + 3.0 * i, 150));
    }
    CHECK(run.state() == FollowState::following);
    CHECK(farthestCorner(run.move().now, squareAt(321, 150)) < 0.25);
}

TEST_CASE("covered, guidance stays where it was, fades, and is neutral; uncovered it comes back") {
    Run run(following(marker(), Look::focus, pictureWith(squareAt(300, 150))));
    for (int i = 0; i < 4; ++i)
        run.see(squareAt(320, 150));
    const RegionMove before = run.move();
    run.cover(12);  // 480 of 500 ms
    CHECK(run.state() == FollowState::holding);
    CHECK(run.move() == before);
    CHECK(run.shown().regions[0]->look == Look::focus);
    run.cover(6);
    CHECK(run.state() == FollowState::fading);
    CHECK(run.move().fade > 0.0);
    CHECK(run.move().fade < 1.0);
    CHECK(run.move().now == before.now);
    run.cover(8);
    CHECK(run.state() == FollowState::lost);
    CHECK(run.shown().regions[0]->look == Look::neutral);
    // Elsewhere, after a search of the whole picture; twelve looks are all of it (partOfSearch), two confirm.
    for (int i = 0; i < 14; ++i)
        run.see(squareAt(120, 90));
    CHECK(run.state() == FollowState::following);
    CHECK(run.shown().regions[0]->look == Look::focus);
    CHECK(farthestCorner(run.move().now, squareAt(120, 90)) < 0.2);
}

TEST_CASE("covered or never seen, a private region is blurred at every moment") {
    Run run(following(marker(Follow::WhenLost::blur), Look::blur, pictureWith(squareAt(300, 150))));
    const bool seen = [&] {
        for (int i = 0; i < 3; ++i)
            run.see(squareAt(300, 150));
        return run.state() == FollowState::following;
    }();
    CHECK(seen);
    for (int i = 0; i < 40; ++i) {
        run.cover(1);
        const auto region = run.shown().regions[0];
        CHECK(region->look == Look::blur);
        CHECK_FALSE(region->strength);
    }
    CHECK(run.state() == FollowState::lost);
}

TEST_CASE("poses that fall silent are held, then the region goes to its safe look; doubtful ones are not followed") {
    Follow follow;
    follow.target = StreamTarget{"/pose/3"};
    Run run(following(follow, Look::focus, pictureWith(squareAt(300, 150))));
    const auto say = [&](double x, double confidence) {
        run.now += kFrame;
        run.tracker.hear("/pose/3", {x / kSize.width, 190.0 / kSize.height, 0.0, confidence}, run.now, run.now);
        run.tracker.hear("/pose/4", {0.0, 0.0, 0.0, 1.0}, run.now, run.now);
    };
    for (int i = 0; i < 5; ++i)
        say(400, 0.9);
    CHECK(run.state() == FollowState::following);
    // The middle of what was painted, (340, 190), is put there.
    CHECK(farthestCorner(run.move().now, moved(run.move().from, Motion{{1, 0, 60, 0, 1, 0, 0, 0, 1}})) < 0.01);
    for (int i = 0; i < 4; ++i)
        say(500, 0.2);
    CHECK(run.state() == FollowState::holding);
    const RegionMove before = run.move();
    run.now += 200.0_ms;
    run.tracker.pass(run.now);
    CHECK(run.move() == before);
    for (int i = 0; i < 30; ++i)
        run.tracker.pass(run.now += 50.0_ms);
    CHECK(run.state() == FollowState::lost);
    CHECK_FALSE(run.tracker.patient());
    CHECK(run.shown().regions[0]->look == Look::neutral);
}

TEST_CASE("a turned pose turns the region about its middle, clockwise in the picture") {
    Follow follow;
    follow.target = StreamTarget{"/pose/1"};
    Run run(following(follow, Look::focus, pictureWith(squareAt(300, 150))));
    for (int i = 0; i < 3; ++i) {
        run.now += kFrame;
        run.tracker.hear("/pose/1", {340.0 / kSize.width, 190.0 / kSize.height, 90.0, 1.0}, run.now, run.now);
    }
    const auto at = motionAt(run.move(), 0.0_s).motion({340, 150});
    CHECK(at.x == doctest::Approx(380));  // what was up is right
    CHECK(at.y == doctest::Approx(190));
}

TEST_CASE("a stroke on a region that poses move leaves it where it is until the next pose") {
    Follow follow;
    follow.target = StreamTarget{"/pose/1"};
    Document document = following(follow, Look::focus, pictureWith(squareAt(300, 150)));
    Run run(document);
    for (int i = 0; i < 3; ++i) {
        run.now += kFrame;
        run.tracker.hear("/pose/1", {420.0 / kSize.width, 220.0 / kSize.height, 0.0, 1.0}, run.now, run.now);
    }
    const Point<CameraFrame> somewhere{350, 180};
    const auto before = motionAt(run.move(), 0.0_s).motion(somewhere);
    Region region = *document.regions[0];
    region.mask = united(region.mask, rasterised(Rectangle{{320, 60}, {360, 120}}, region.mask.size()));
    document.regions[0] = Box(region);
    run.tracker.follow(document);
    const auto after = motionAt(run.move(), 0.0_s).motion(somewhere);
    CHECK(after.x == doctest::Approx(before.x));
    CHECK(after.y == doctest::Approx(before.y));
}

TEST_CASE("what cannot be followed says why, and stays where it was painted") {
    Follow other = marker();
    other.target = MarkerTarget{"APRILTAG_36h11", 9};
    Run run(following(other, Look::focus, pictureWith(squareAt(300, 150))));
    run.see(squareAt(320, 150));
    CHECK(run.tracker.now().at(0).trouble.find("not in the scene's picture") != std::string::npos);
    CHECK(run.tracker.moves(run.now, kSweep).empty());
    Follow flat;
    flat.target = PlanarTarget{{10, 10, 60, 60}};
    CHECK(Run(following(flat, Look::focus, pictureWith(squareAt(300, 150))))
              .tracker.now()[0]
              .trouble.find("too little texture") != std::string::npos);
    CHECK(Run(following(marker(), Look::focus, pictureWith(squareAt(300, 150)))).tracker.now()[0].trouble.empty());
    run = Run(following(marker(), Look::focus, pictureWith(squareAt(300, 150))));
    run.see(Image<std::uint8_t>({320, 180}, 1, std::vector<std::uint8_t>(320 * 180, 90)));
    CHECK(run.tracker.now()[0].trouble.find("320 x 180") != std::string::npos);
}

TEST_CASE("without a camera nothing that is looked for changes; edits do not interrupt what is followed") {
    Document document = following(marker(), Look::focus, pictureWith(squareAt(300, 150)));
    Run run(document);
    for (int i = 0; i < 4; ++i)
        run.see(squareAt(320, 150));
    const RegionMove before = run.move();
    Region painted = *document.regions[0];
    painted.mask = rasterised(Rectangle{{280, 140}, {400, 240}}, kSize);
    document.regions[0] = Box(painted);
    run.tracker.follow(document);
    CHECK(run.move() == before);
    run.tracker.follow(document, {false, true});
    CHECK_FALSE(run.tracker.follows());
    CHECK(run.tracker.moves(run.now, kSweep).empty());
}

TEST_CASE("a printed page is followed as it slides and turns") {
    std::mt19937 random(4);
    std::uniform_int_distribution<int> any(0, 255);
    const auto page = [&] {  // soft patches of some pixels, as print has
        cv::Mat cells(45, 80, CV_8UC1), drawn;
        for (int i = 0; i < 45 * 80; ++i)
            cells.data[i] = static_cast<std::uint8_t>(any(random));
        cv::resize(cells, drawn, {kSize.width, kSize.height}, 0, 0, cv::INTER_CUBIC);
        return drawn;
    }();
    const auto seenAt = [&](const Motion& motion) {
        // OpenCV's pixel centres are whole numbers: the motion is shifted by half a pixel on both sides.
        const cv::Matx33d half(1, 0, 0.5, 0, 1, 0.5, 0, 0, 1);
        cv::Mat drawn;
        cv::warpPerspective(page, drawn, half.inv() * cv::Matx33d(motion.m.data()) * half, page.size(), cv::INTER_CUBIC,
                            cv::BORDER_REFLECT_101);
        return Image<std::uint8_t>(kSize, 1, std::vector<std::uint8_t>(drawn.datastart, drawn.dataend));
    };
    Follow flat;
    flat.target = PlanarTarget{{240, 110, 400, 250}};
    Run run(following(flat, Look::focus, seenAt(Motion{})));
    Motion motion;
    for (int i = 1; i <= 10; ++i) {
        const double a = 0.01 * i, x = 2.0 * i;
        motion = {{std::cos(a), -std::sin(a), x, std::sin(a), std::cos(a), 0, 0, 0, 1}};
        run.see(seenAt(motion));
    }
    CHECK(run.state() == FollowState::following);
    const Quad patch = cornersOf({240, 110, 400, 250});
    // Flow finds points to some 0.05 px, and the patch's corners lie beyond them; the turn is no straight line.
    CHECK(farthestCorner(moved(patch, motionAt(run.move(), 0.0_s).motion), moved(patch, motion)) < 0.5);
}

}  // namespace ilf
