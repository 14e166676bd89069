#include <doctest/doctest.h>

#include <random>

#include "core/registration/point_pairs.h"
#include "tests/support/law.h"

namespace {

using namespace ilf;

constexpr Size kCamera{1280, 1024}, kProjector{1024, 768};
const std::array<Point<CameraFrame>, 4> kCorners{{{212, 190}, {1105, 240}, {1060, 870}, {180, 800}}};

/// A tilted view of a flat scene, the way to the camera written out.
Point<CameraFrame> seen(Point<ProjectorFrame> p) {
    const double w = 1.0 + 1.2e-4 * p.x - 0.8e-4 * p.y;
    return {(0.9 * p.x + 0.05 * p.y + 150.0) / w, (-0.04 * p.x + 0.95 * p.y + 120.0) / w};
}

std::vector<PointPair> pairsOf(int count, double noise_px, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(20.0, 1000.0), y(20.0, 750.0);
    std::normal_distribution<double> noise(0.0, noise_px > 0.0 ? noise_px : 1.0);
    std::vector<PointPair> pairs;
    for (int i = 0; i < count; ++i) {
        const Point<ProjectorFrame> at{x(random), y(random)};
        PointPair pair{seen(at), at};
        if (noise_px > 0.0) pair.projector.x += noise(random), pair.projector.y += noise(random);
        pairs.push_back(pair);
    }
    return pairs;
}

std::string refusal(const std::array<Point<CameraFrame>, 4>& corners) {
    const auto refused = registeredByCorners(corners, kCamera, kProjector);
    return refused ? "accepted" : refused.error().what;
}
bool says(const std::string& text, const std::string& words) {
    const bool said = text.find(words) != std::string::npos;
    if (!said) MESSAGE("said instead: " << text);
    return said;
}

/// What a camera sees of a raster's picture on a flat scene with a texture, under other light; sampled 4 x 4.
Image<std::uint8_t> photo(const Image<std::uint8_t>& picture, const Homography<ProjectorFrame, CameraFrame>& way) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < kCamera.height; ++y) {
        for (int x = 0; x < kCamera.width; ++x) {
            double light = 0.0;
            for (int s = 0; s < 16; ++s) {
                const auto p = way(Point<CameraFrame>{x + (s % 4 + 0.5) / 4.0, y + (s / 4 + 0.5) / 4.0});
                const bool lit = p.x >= 0 && p.y >= 0 && p.x < kProjector.width && p.y < kProjector.height;
                if (lit) light += picture.at(static_cast<int>(p.x), static_cast<int>(p.y)) / 16.0;
            }
            const double colour = (x / 90 + y / 70) % 2 == 0 ? 0.35 : 0.8;  // of the scene
            pixels.push_back(static_cast<std::uint8_t>(colour * (8.0 + 0.8 * light)));
        }
    }
    return {kCamera, 1, std::move(pixels)};
}

}  // namespace

TEST_CASE("four corners: each lands on its corner of the raster") {
    const auto found = registeredByCorners(kCorners, kCamera, kProjector);
    REQUIRE_MESSAGE(found, found.error().what);
    const auto& map = found->registration.map;
    CHECK(map.toProjector(kCorners[0]).x == doctest::Approx(0.0).scale(1000.0));
    CHECK(map.toProjector(kCorners[2]).x == doctest::Approx(1024.0));
    CHECK(map.toProjector(kCorners[2]).y == doctest::Approx(768.0));
    CHECK(found->registration.method == Registration::Method::corners);
    CHECK(found->registration.points == 4);
    CHECK(found->registration.projector == kProjector);
    CHECK(found->registration.camera.picture == kCamera);
}

TEST_CASE("four corners: folded, crossed, flat and mirrored ones are refused with the reason") {
    auto corners = kCorners;
    corners[2] = {400, 400};
    CHECK(says(refusal(corners), "The lower right corner is folded in"));
    corners = kCorners;
    std::swap(corners[1], corners[2]);
    CHECK(says(refusal(corners), "crosses itself"));
    corners = kCorners;
    corners[1] = {0.5 * (corners[0].x + corners[2].x), 0.5 * (corners[0].y + corners[2].y)};
    CHECK(says(refusal(corners), "The upper right corner lies on a line"));
    corners = kCorners;
    corners[3] = corners[0];
    CHECK(says(refusal(corners), "lies on a line"));
    corners = kCorners;
    std::swap(corners[0], corners[1]), std::swap(corners[2], corners[3]);
    CHECK(says(refusal(corners), "mirrored"));
    corners[0].x = std::nan("");
    CHECK(says(refusal(corners), "not a number"));
}

TEST_CASE("four corners: any convex outline that turns the right way is taken, and each corner lands") {
    law("corners land on corners", [] {
        std::array<Point<CameraFrame>, 4> corners{{{0, 0}, {1000, 0}, {1000, 800}, {0, 800}}};
        for (auto& c : corners) {  // each within its quarter's outer part: the outline stays convex
            c.x += 0.01 * *rc::gen::inRange(-15000, 15000);
            c.y += 0.01 * *rc::gen::inRange(-15000, 15000);
        }
        const auto found = registeredByCorners(corners, kCamera, kProjector);
        RC_ASSERT(found.has_value());
        const auto p = found->registration.map.toProjector(corners[3]);
        RC_ASSERT(std::abs(p.x) < 1e-3 && std::abs(p.y - 768.0) < 1e-3);
        RC_ASSERT(found->registration.worst_px < 1e-3);
    });
}

TEST_CASE("point pairs: exact pairs give the exact map; noisy ones give residuals of that size") {
    const auto exact = registeredByPairs(pairsOf(6, 0.0, 1), kCamera, kProjector);
    REQUIRE_MESSAGE(exact, exact.error().what);
    const auto p = exact->registration.map.toProjector(seen({500, 300}));
    CHECK(p.x == doctest::Approx(500.0));
    CHECK(p.y == doctest::Approx(300.0));
    CHECK(exact->registration.rms_px < 1e-4);
    const auto noisy = registeredByPairs(pairsOf(40, 0.5, 2), kCamera, kProjector);
    REQUIRE(noisy);
    CHECK(noisy->registration.rms_px == doctest::Approx(0.7).epsilon(0.2));
    CHECK(noisy->residual_px[static_cast<std::size_t>(noisy->worst)] == noisy->registration.worst_px);
    CHECK(noisy->note.empty());
}

TEST_CASE("point pairs: a wrong one is left out and named; four pairs say that they always fit") {
    auto pairs = pairsOf(9, 0.5, 3);
    pairs[4].projector.x += 60.0;
    const auto found = registeredByPairs(pairs, kCamera, kProjector);
    REQUIRE_MESSAGE(found, found.error().what);
    CHECK_FALSE(found->used[4]);
    CHECK(found->worst == 4);
    CHECK(found->residual_px[4] == doctest::Approx(60.0).epsilon(0.1));
    CHECK(says(found->note, "pair 5"));
    CHECK(found->registration.points == 8);
    CHECK(found->registration.worst_px < 3.0);

    const auto four = registeredByPairs(pairsOf(4, 0.5, 4), kCamera, kProjector);
    REQUIRE(four);
    CHECK(says(four->note, "always fit"));
}

TEST_CASE("point pairs: what tells no map is refused with the reason") {
    const auto refused = [](std::vector<PointPair> pairs) {
        const auto found = registeredByPairs(pairs, kCamera, kProjector);
        return found ? std::string("accepted") : found.error().what;
    };
    CHECK(says(refused(pairsOf(3, 0.0, 1)), "too few"));
    auto line = pairsOf(6, 0.0, 1);
    for (std::size_t i = 0; i < 5; ++i) {  // all but one
        const double at = static_cast<double>(i);
        line[i].projector = {100.0 + 90.0 * at, 50.0 + 80.0 * at};
        line[i].camera = seen(line[i].projector);
    }
    CHECK(says(refused(line), "on one line"));
    auto mirrored = pairsOf(8, 0.0, 1);
    for (PointPair& pair : mirrored)
        pair.projector.x = 1024.0 - pair.projector.x;
    CHECK(says(refused(mirrored), "mirrored"));
    auto mixed = pairsOf(12, 0.0, 1);
    std::mt19937 random(77);
    std::uniform_real_distribution<double> off(-60.0, 60.0);
    for (PointPair& pair : mixed)
        pair.projector.x += off(random), pair.projector.y += off(random);
    CHECK(says(refused(mixed), "do not fit each other"));
}

TEST_CASE("projected chessboard: its corners register a picture on a chequered scene, either way up") {
    const auto picture = projectedBoardPicture(kProjector, false), inverse = projectedBoardPicture(kProjector, true);
    // The camera upright, and on its head.
    const std::array<Homography<ProjectorFrame, CameraFrame>, 2> ways{
        Homography<ProjectorFrame, CameraFrame>{{1.05, -0.06, -140.0, 0.05, 1.02, -130.0, 1e-5, -2e-5, 1.0}},
        Homography<ProjectorFrame, CameraFrame>{{-1.05, 0.06, 1170.0, -0.05, -1.02, 930.0, 1e-5, -2e-5, 1.0}}};
    for (const auto& way : ways) {
        const auto found = registeredByBoard(photo(picture, way), photo(inverse, way), kProjector);
        REQUIRE_MESSAGE(found, found.error().what);
        CHECK(found->registration.method == Registration::Method::chessboard);
        CHECK(found->registration.points >= 50);
        CHECK(found->registration.rms_px < 0.15);
        for (const Point<CameraFrame> at : {Point<CameraFrame>{400, 400}, Point<CameraFrame>{800, 600}}) {
            const auto there = found->registration.map.toProjector(at), truth = way(at);
            CHECK(std::abs(there.x - truth.x) < 0.1);
            CHECK(std::abs(there.y - truth.y) < 0.1);
        }
    }
    const auto nothing = registeredByBoard(photo(inverse, ways[0]), photo(inverse, ways[0]), kProjector);
    REQUIRE_FALSE(nothing);
    CHECK(says(nothing.error().what, "chessboard that the projector shows is not seen whole"));
}
