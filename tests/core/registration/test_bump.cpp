// The bump alarm on made-up pictures: a moved camera, a hand, other light, darkness.
#include "core/registration/bump.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/support/law.h"
#include "tests/support/scanned_map.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;

using Motion = cv::Matx33d;

Image<std::uint8_t> imageOf(const cv::Mat& grey) {
    const cv::Mat whole = grey.isContinuous() ? grey : grey.clone();
    return {{whole.cols, whole.rows}, 1, std::vector<std::uint8_t>(whole.datastart, whole.dataend)};
}

/// Printed things on a table: bars, discs and letters at random, larger than the picture.
cv::Mat table() {
    static const cv::Mat made = [] {
        cv::Mat grey(900, 1500, CV_8U, cv::Scalar(120));
        std::mt19937 random(3);
        const auto number = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
        for (int i = 0; i < 500; ++i) {
            const cv::Point at(number(1500), number(900));
            const cv::Scalar ink(30 + number(200));
            if (i % 3 == 0) cv::rectangle(grey, at, at + cv::Point(5 + number(60), 5 + number(40)), ink, cv::FILLED);
            if (i % 3 == 1) cv::circle(grey, at, 3 + number(25), ink, cv::FILLED, cv::LINE_AA);
            if (i % 3 == 2)
                cv::putText(grey, std::string(1, static_cast<char>('A' + number(26))), at, cv::FONT_HERSHEY_SIMPLEX,
                            0.5 + number(20) / 10.0, ink, 2, cv::LINE_AA);
        }
        cv::GaussianBlur(grey, grey, {3, 3}, 0.8);
        return grey;
    }();
    return made;
}

/// The camera's picture after it moved: 1280 x 720 of the table.
cv::Mat seenAfter(const Motion& newFromOld, const cv::Mat& scene = table(), cv::Size size = {1280, 720}) {
    const Motion corner(1, 0, -(scene.cols - size.width) / 2, 0, 1, -(scene.rows - size.height) / 2, 0, 0, 1);
    cv::Mat picture;
    cv::warpPerspective(scene, picture, newFromOld * corner, size, cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    return picture;
}

cv::Mat noisy(cv::Mat picture, double sigma, unsigned seed) {
    cv::Mat noise(picture.size(), CV_16S);
    cv::RNG random(seed);
    random.fill(noise, cv::RNG::NORMAL, 0, sigma);
    cv::Mat sum;
    picture.convertTo(sum, CV_16S);
    sum += noise;
    sum.convertTo(picture, CV_8U);
    return picture;
}

Motion turned(double degrees, double dx, double dy) {
    const double a = degrees * 3.14159265358979 / 180.0, c = std::cos(a), s = std::sin(a);
    return {c, -s, 640 - c * 640 + s * 360 + dx, s, c, 360 - s * 640 - c * 360 + dy, 0, 0, 1};
}

double farthest(const Homography<CameraFrame, CameraFrame>& found, const Motion& truth) {
    double most = 0.0;
    for (const double x : {100.0, 640.0, 1180.0}) {
        for (const double y : {100.0, 360.0, 620.0}) {
            const auto p = found(Point<CameraFrame>{x + 0.5, y + 0.5});
            const cv::Vec3d q = truth * cv::Vec3d(x, y, 1.0);
            most = std::max(most, std::hypot(p.x - 0.5 - q[0] / q[2], p.y - 0.5 - q[1] / q[2]));
        }
    }
    return most;
}

const BumpAlarm& alarm() {
    static const BumpAlarm made = BumpAlarm::of(imageOf(seenAfter(Motion::eye()))).value();
    return made;
}

}  // namespace

TEST_CASE("bump: a camera that stands still is not bumped, whatever noise and light do") {
    for (const double gain : {0.4, 0.8, 1.0, 1.2}) {
        cv::Mat picture;
        seenAfter(Motion::eye()).convertTo(picture, CV_8U, gain, 10);
        const BumpReport report = alarm().compared(imageOf(noisy(picture, 3.0, 5))).value();
        CAPTURE(gain);
        CHECK_FALSE(report.bumped);
        CHECK_FALSE(report.blind);
        CHECK(report.found > 0.7);
        CHECK(report.moved_px < 0.4);
        CHECK_FALSE(report.newFromOld);
    }
}

TEST_CASE("bump: a camera that was moved is noticed, and where it points now is found") {
    struct Case {
        Motion motion;
        double moved;
    };
    const Case cases[] = {{turned(0, 2.3, 0), 2.3},
                          {turned(0, -6, 4), 7.2},
                          {turned(0, 25, -11), 27.3},
                          {turned(0, 70, 40), 80.6},
                          {turned(1.5, 5, 8), 0.0},
                          {turned(-4, 12, 3), 0.0},
                          {{1.01, 0.004, -8, -0.003, 1.012, 5, 4e-6, -3e-6, 1}, 0.0}};
    for (const Case& one : cases) {
        const BumpReport report = alarm().compared(imageOf(noisy(seenAfter(one.motion), 3.0, 9))).value();
        CAPTURE(cv::Mat(one.motion));
        CAPTURE(report.found);
        CAPTURE(report.stayed);
        REQUIRE(report.bumped);
        REQUIRE(report.newFromOld);
        CHECK(farthest(*report.newFromOld, one.motion) < 0.5);
        if (one.moved > 0.0) CHECK(report.moved_px == doctest::Approx(one.moved).epsilon(0.1));
    }
}

TEST_CASE("bump: a hand in the picture, or a thing that moves on the table, is no bump") {
    cv::Mat hand = seenAfter(Motion::eye());
    cv::ellipse(hand, {500, 400}, {330, 210}, 30, 0, 360, cv::Scalar(170), cv::FILLED);
    BumpReport report = alarm().compared(imageOf(noisy(hand, 3.0, 2))).value();
    CHECK_FALSE(report.bumped);
    CHECK_FALSE(report.blind);
    CHECK(report.stayed > 0.9);

    cv::Mat moved = seenAfter(Motion::eye());
    const cv::Rect thing(700, 150, 450, 400);
    seenAfter(Motion::eye())(thing).copyTo(moved(thing + cv::Point(37, -21)));
    report = alarm().compared(imageOf(noisy(moved, 3.0, 4))).value();
    CHECK_FALSE(report.bumped);
    CHECK(report.stayed > 0.5);
}

TEST_CASE("bump: a dark picture or another scene tells nothing, and says so") {
    const cv::Mat dark(720, 1280, CV_8U, cv::Scalar(4));
    BumpReport report = alarm().compared(imageOf(noisy(dark, 2.0, 1))).value();
    CHECK(report.blind);
    CHECK_FALSE(report.bumped);
    cv::Mat other;
    cv::flip(seenAfter(Motion::eye()), other, -1);
    report = alarm().compared(imageOf(other)).value();
    CHECK_FALSE(report.bumped);
}

TEST_CASE("bump: pictures that cannot serve are refused in words") {
    const cv::Mat even(720, 1280, CV_8U, cv::Scalar(128));
    CHECK(BumpAlarm::of(imageOf(even)).error().what.find("corners") != std::string::npos);
    CHECK_FALSE(BumpAlarm::of(imageOf(cv::Mat(20, 20, CV_8U, cv::Scalar(1)))));
    const cv::Mat small(360, 640, CV_8U, cv::Scalar(128));
    CHECK(alarm().compared(imageOf(small)).error().what.find("size") != std::string::npos);
}

TEST_CASE("bump: the old registration moved along puts what is seen now where it was") {
    const Homography<ProjectorFrame, CameraFrame> plane{{0.8, 0.03, 5, -0.02, 0.85, 3, 2e-5, -1e-5, 1}};
    const Homography<CameraFrame, CameraFrame> newFromOld{{0.999, -0.01, 6, 0.01, 0.999, -4, 0, 0, 1}};
    const Registration scanned = *registered(Box<DenseMap>(sampledMap(plane, {160, 120}, {140, 110}, 0.6)));
    for (const Registration& before : {*registered(plane), scanned}) {
        const Registration after = afterBump(before, newFromOld);
        for (const Point<CameraFrame> old : {Point<CameraFrame>{30, 40}, {80, 60}, {120, 90}}) {
            const auto was = before.map.toProjector(old), is = after.map.toProjector(newFromOld(old));
            CHECK(std::hypot(was.x - is.x, was.y - is.y) < 0.02);
            const auto back = after.map.toCamera(is), expected = newFromOld(before.map.toCamera(was));
            CHECK(std::hypot(back.x - expected.x, back.y - expected.y) < 0.02);
        }
        CHECK(after.method == before.method);
    }
}
