// A search that is shared out over pictures finds what one look at everything finds.
#include <doctest/doctest.h>

#include <numbers>

#include "core/track/marker.h"
#include "tests/core/track/drawn_marker.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kPicture{1280, 720};
constexpr int kLooks = 12;

TEST_CASE("no look takes more than half a picture's pixels, and all full-size looks together take every one twice") {
    for (const Size size : {kPicture, Size{640, 480}, Size{1920, 1080}, Size{1280, 1024}}) {
        std::vector<int> rows(static_cast<std::size_t>(size.height), 0);
        int fewest = 0;
        for (int look = 0; fewest < 2 && look < 100; ++look) {
            const MarkerSearch part = partOfSearch({"APRILTAG_36h11", {7}, {}, 1}, size, look);
            CHECK(part.around > 0);
            if (part.coarse == 2) {
                CHECK(part.window.empty());
                continue;
            }
            CHECK(part.window.width() == size.width);
            if (size.width * size.height > 600'000) CHECK(2 * part.window.height() <= size.height);
            for (int y = part.window.y0; y < part.window.y1; ++y)
                ++rows[static_cast<std::size_t>(y)];
            fewest = *std::ranges::min_element(rows);
        }
        CHECK(fewest == 2);
    }
    CHECK(partOfSearch({}, kPicture, 2 * 6 - 1).window.y1 == kPicture.height);
}

TEST_CASE("a small marker anywhere is found within twelve looks, a large one within the first") {
    law("parts", [] {
        const bool large = *rc::gen::arbitrary<bool>();
        const double side = large ? *rc::gen::inRange(60, 200) : *rc::gen::inRange(22, 40);
        const double x = *rc::gen::inRange(150, 1130), y = *rc::gen::inRange(150, 570);
        const double angle = *rc::gen::inRange(0, 360) * std::numbers::pi / 180.0;
        const double c = 0.5 * side * std::cos(angle), s = 0.5 * side * std::sin(angle);
        const Quad truth{
            {{x - c + s, y - s - c}, {x + c + s, y + s - c}, {x + c - s, y + s + c}, {x - c - s, y - s + c}}};
        DrawnScene scene;
        scene.size = kPicture;
        const auto picture = drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 7, truth);
        int look = 0;
        for (; look < kLooks; ++look) {
            const auto seen = findMarkers(picture, partOfSearch({"APRILTAG_36h11", {7}, {}, 1}, kPicture, look));
            RC_ASSERT(seen.has_value());
            if (seen->empty()) continue;
            RC_ASSERT(farthestCorner(seen->front().corners, truth) < 0.15);
            break;
        }
        RC_ASSERT(look < (large ? 1 : kLooks));
    });
}

}  // namespace

}  // namespace ilf
