// Markers drawn at known places are found there; what is not asked for is not.
#include "core/track/marker.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numbers>

#include "tests/core/track/drawn_marker.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

Quad turnedSquare(double x, double y, double side, double degrees, double tilt) {
    const double c = std::cos(degrees * std::numbers::pi / 180.0), s = std::sin(degrees * std::numbers::pi / 180.0);
    Quad q{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    for (auto& p : q) {
        const double w = 1.0 + tilt * p.y;  // seen at a slant
        p = {x + side * (c * p.x - s * p.y) / w, y + side * (s * p.x + c * p.y) / w};
    }
    return q;
}

MarkerSearch searchFor(std::vector<int> ids) { return {"APRILTAG_36h11", std::move(ids), {}, 1}; }

}  // namespace

TEST_CASE("a marker's corners are found within 0.15 px, turned, slanted and in noise") {
    law("corners", [] {
        const double side = *rc::gen::inRange(280, 1500) / 10.0;
        const Quad truth =
            turnedSquare(320.0 + *rc::gen::inRange(0, 100) / 100.0, 180.0 + *rc::gen::inRange(0, 100) / 100.0, side,
                         *rc::gen::inRange(0, 360), *rc::gen::inRange(-15, 16) / 100.0);
        DrawnScene scene;
        scene.noise = 2.0;
        scene.seed = *rc::gen::arbitrary<unsigned>();
        const auto seen = findMarkers(drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 7, truth), searchFor({7}));
        RC_ASSERT(seen.has_value());
        RC_ASSERT(seen->size() == 1U);
        RC_ASSERT(seen->front().id == 7);
        // An edge is found to noise x sqrt(3 pixels of its rise) / step = 2 x 1.7 / 170 = 0.02 px; a side of 28 px has
        // 19 of them, so its line's end is known to 2 x 0.02 / sqrt(19) = 0.01, a corner of two slanted ones to 0.016.
        // The worst of 800 coordinates is within 4.5 deviations, 0.07, and bilinear steps between pixels bend the rise
        // of a slanted edge by up to 0.06 more.
        RC_ASSERT(farthestCorner(seen->front().corners, truth) < 0.15);
        // Nine in ten places along the outline have a clear edge (near corners another side's bends it), and 0.15 px
        // about the lines take another 6 %.
        RC_ASSERT(seen->front().confidence > 0.8);
    });
}

TEST_CASE("the corners come in the marker's own order, clockwise from its top left") {
    for (const int turn : {0, 90, 180, 270}) {
        const Quad truth = turnedSquare(300, 200, 60, turn, 0.0);
        const auto seen = findMarkers(drawnMarker({}, cv::aruco::DICT_6X6_250, 23, truth), {"6X6_250", {23}, {}, 1});
        REQUIRE(seen);
        REQUIRE(seen->size() == 1);
        // Without noise: what bilinear steps leave (above), and 8 x 8 samples of the drawing, 1/16 px. Another corner
        // of the marker would be 60 px away.
        CHECK(farthestCorner(seen->front().corners, truth) < 0.1);
    }
}

TEST_CASE("only the ids asked for are seen, and only inside the window") {
    const Quad truth = turnedSquare(300, 200, 60, 10, 0.0);
    const auto picture = drawnMarker({}, cv::aruco::DICT_APRILTAG_36h11, 7, truth);
    CHECK(findMarkers(picture, searchFor({8, 9}))->empty());
    CHECK(findMarkers(picture, searchFor({}))->empty());
    auto search = searchFor({7});
    search.window = {0, 0, 200, 360};
    CHECK(findMarkers(picture, search)->empty());
    search.window = boxAround(truth).grown(20);
    REQUIRE(findMarkers(picture, search)->size() == 1);
    CHECK(farthestCorner(findMarkers(picture, search)->front().corners, truth) < 0.1);
    search.window = {250, 150, 10'000, 10'000};  // beyond the picture
    CHECK(findMarkers(picture, search)->size() == 1);
}

TEST_CASE("looked for in a smaller picture, the corners are as exact") {
    const Quad truth = turnedSquare(300.3, 200.6, 90, 25, 0.1);
    auto search = searchFor({7});
    search.coarse = 2;
    const auto seen = findMarkers(drawnMarker({}, cv::aruco::DICT_APRILTAG_36h11, 7, truth), search);
    REQUIRE(seen);
    REQUIRE(seen->size() == 1);
    CHECK(farthestCorner(seen->front().corners, truth) < 0.1);
}

TEST_CASE("a faint marker is less sure than a clear one") {
    const Quad truth = turnedSquare(300, 200, 60, 10, 0.0);
    DrawnScene faint;
    faint.dark = 95.0;
    faint.light = 115.0;
    const auto clear = findMarkers(drawnMarker({}, cv::aruco::DICT_APRILTAG_36h11, 7, truth), searchFor({7}));
    const auto weak = findMarkers(drawnMarker(faint, cv::aruco::DICT_APRILTAG_36h11, 7, truth), searchFor({7}));
    REQUIRE(clear->size() == 1);
    REQUIRE(weak->size() == 1);
    // A step of 20 grey values is half of what counts as sure (40); the rest of the outline is as clear.
    CHECK(weak->front().confidence < 0.6 * clear->front().confidence);
}

TEST_CASE("unknown dictionaries and numbers are refused in words") {
    CHECK(checkedMarker("APRILTAG_36h11", 586));
    CHECK(checkedMarker("APRILTAG_36h11", 587).error().fault == Fault::outOfRange);
    CHECK(checkedMarker("KLINGON", 0).error().fault == Fault::unsupported);
    const auto picture = drawnMarker({}, cv::aruco::DICT_APRILTAG_36h11, 7, turnedSquare(300, 200, 60, 10, 0.0));
    CHECK(findMarkers(picture, {"6X6_250", {250}, {}, 1}).error().what.find("0 to 249") != std::string::npos);
}

}  // namespace ilf
