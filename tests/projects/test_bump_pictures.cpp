// The bump alarm on real pictures, moved by known amounts, in other light, and with something before them.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/registration/bump.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;

Image<std::uint8_t> imageOf(const cv::Mat& grey) {
    const cv::Mat whole = grey.isContinuous() ? grey : grey.clone();
    return {{whole.cols, whole.rows}, 1, std::vector<std::uint8_t>(whole.datastart, whole.dataend)};
}

/// What a camera sees of the photo that turned a little and moved by (dx, dy); the rim around it is never seen.
cv::Mat window(const cv::Mat& photo, double degrees, double dx, double dy, double gain) {
    const int rim = 50;
    const cv::Size size(photo.cols - 2 * rim, photo.rows - 2 * rim);
    const double a = degrees * 3.14159265358979 / 180.0, c = std::cos(a), s = std::sin(a);
    const cv::Matx33d newFromOld(c, -s, dx, s, c, dy, 0, 0, 1), corner(1, 0, -rim, 0, 1, -rim, 0, 0, 1);
    cv::Mat seen;
    cv::warpPerspective(photo, seen, newFromOld * corner, size, cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    seen.convertTo(seen, CV_8U, gain, 3);
    return seen;
}

}  // namespace

TEST_CASE("bump: photos that move by known amounts are noticed and measured; light and hands are no bumps") {
    for (const char* name : {"03_procam/kamino410/capture_0/graycode_40.png", "04_tracking/planar/box_in_scene.png",
                             "04_tracking/aruco/singlemarkersoriginal.jpg", "06_textures/skimage/coffee.png"}) {
        CAPTURE(name);
        const auto path = testData(name);
        if (!path) continue;
        const cv::Mat photo = cv::imread(path->string(), cv::IMREAD_GRAYSCALE);
        REQUIRE_FALSE(photo.empty());
        const auto alarm = BumpAlarm::of(imageOf(window(photo, 0, 0, 0, 1.0)));
        REQUIRE_MESSAGE(alarm, alarm.error().what);
        for (const double gain : {0.6, 1.0}) {
            CAPTURE(gain);
            const auto still = alarm->compared(imageOf(window(photo, 0, 0, 0, gain))).value();
            CHECK_FALSE(still.bumped);
            CHECK(still.found > 0.7);
            for (const auto& [degrees, dx, dy] : {std::array{0.0, 3.0, -2.0}, {0.0, 21.5, 9.25}, {1.0, 6.0, 4.0}}) {
                CAPTURE(dx);
                const auto moved = alarm->compared(imageOf(window(photo, degrees, dx, dy, gain))).value();
                CAPTURE(moved.found);
                CAPTURE(moved.stayed);
                REQUIRE(moved.bumped);
                const double a = degrees * 3.14159265358979 / 180.0, x = 0.5 * photo.cols - 50,
                             y = 0.5 * photo.rows - 50;
                const auto to = (*moved.newFromOld)(Point<CameraFrame>{x + 0.5, y + 0.5});
                CHECK(std::abs(to.x - 0.5 - (std::cos(a) * x - std::sin(a) * y + dx)) < 0.1);
                CHECK(std::abs(to.y - 0.5 - (std::sin(a) * x + std::cos(a) * y + dy)) < 0.1);
            }
        }
        cv::Mat hand = window(photo, 0, 0, 0, 1.0);
        cv::circle(hand, {hand.cols / 3, hand.rows / 2}, hand.rows / 4, cv::Scalar(150), cv::FILLED);
        CHECK_FALSE(alarm->compared(imageOf(hand)).value().bumped);
    }
}
