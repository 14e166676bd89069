// Real photographs: OpenCV's chessboard series, and one pose of a real camera and projector.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/registration/calibrate.h"
#include "core/registration/gray_code.h"
#include "projects/pictures.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;

/// The decoded real capture: patterns as procam-calibration shows them (columns, then rows, each bit beside its
/// inverse; then white, then black).
struct Capture {
    Image<std::uint8_t> white;
    DecodedScan decoded;
};

std::optional<Capture> realCapture() {
    const auto folder = testData("03_procam/kamino410/capture_0");
    if (!folder) return std::nullopt;
    Scan scan;
    scan.projector = {1024, 768};
    const auto shows = [&](const Pattern& pattern) {
        char name[32];
        std::snprintf(name, sizeof name, "graycode_%02zu.png", scan.patterns.size());
        auto picture = projects::readMask(*folder / name);
        REQUIRE_MESSAGE(picture, picture.error().what);
        scan.patterns.push_back(pattern);
        scan.pictures.push_back(*std::move(picture));
    };
    for (const auto kind : {Pattern::Kind::column, Pattern::Kind::row})
        for (int bit = 0; bit < 10; ++bit)
            for (const bool inverse : {false, true})
                shows({kind, bit, inverse});
    shows({Pattern::Kind::white, 0, false});
    shows({Pattern::Kind::black, 0, false});
    auto decoded = decodedScan(scan);
    REQUIRE_MESSAGE(decoded, decoded.error().what);
    return Capture{scan.pictures[40], *std::move(decoded)};
}

}  // namespace

TEST_CASE("board photos: OpenCV's thirteen chessboards give the camera that OpenCV found") {
    std::vector<BoardView> views;
    const Board board{9, 6, 25.0_mm};
    for (const int number : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}) {
        char name[64];
        std::snprintf(name, sizeof name, "04_tracking/chessboard/left%02d.jpg", number);
        const auto file = testData(name);
        if (!file) return;
        const auto picture = projects::readMask(*file);
        REQUIRE(picture);
        auto corners = boardCorners(*picture, board, name);
        REQUIRE_MESSAGE(corners, corners.error().what);
        BoardView view;
        view.name = name;
        view.camera = picture->size();
        view.inCamera = *std::move(corners);
        views.push_back(std::move(view));
    }
    const auto found = calibratedCamera(views, board);
    REQUIRE_MESSAGE(found, found.error().what);
    const Pinhole& c = found->camera;
    for (const std::string& note : found->notes)
        MESSAGE(note);
    MESSAGE("f " << c.fx << " " << c.fy << " c " << c.cx << " " << c.cy << " k1 " << c.distortion[0] << " k2 "
                 << c.distortion[1] << " rms " << found->rms_px << " +- " << found->deviation.fx);
    // left_intrinsics.yml has f 535.916, 0.55 % more, and an rms of 0.39 px: the case below makes that very number, and
    // what it is without the slipped corners. OpenCV's tutorial on the same pictures has f 532.8, c 342.5 233.9, k1
    // -0.28. Centres: + 0.5.
    CHECK(found->poses[1].used);
    CHECK(c.fx == doctest::Approx(532.76).epsilon(0.001));
    CHECK(c.fy == doctest::Approx(532.76).epsilon(0.001));
    CHECK(std::abs(c.cx - 342.8) < 1.0);
    CHECK(std::abs(c.cy - 236.05) < 2.0);
    CHECK(c.distortion[0] == doctest::Approx(-0.28).epsilon(0.08));
    CHECK(found->rms_px < 0.25);
    CHECK(found->deviation.fx > 0.05);
    CHECK(found->deviation.fx < 3.0);
}

TEST_CASE("board photos: left_intrinsics.yml comes of corners that slipped to their neighbours, and is made again so") {
    std::vector<std::vector<cv::Point2f>> wide, fitting;
    for (const int number : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}) {
        char name[64];
        std::snprintf(name, sizeof name, "04_tracking/chessboard/left%02d.jpg", number);
        const auto file = testData(name);
        if (!file) return;
        const cv::Mat grey = cv::imread(file->string(), cv::IMREAD_GRAYSCALE);
        std::vector<cv::Point2f> corners;
        REQUIRE(cv::findChessboardCorners(grey, {9, 6}, corners));
        // As OpenCV's sample does it: 23 x 23 pixels about each corner, which in left02, 07, 09 and 13 is more than a
        // square of the board.
        const cv::TermCriteria enough(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 30, 0.1);
        fitting.push_back(corners);
        cv::cornerSubPix(grey, fitting.back(), {5, 5}, {-1, -1}, enough);
        cv::cornerSubPix(grey, corners, {11, 11}, {-1, -1}, enough);
        wide.push_back(std::move(corners));
    }
    std::vector<cv::Point3f> board;
    for (int i = 0; i < 54; ++i)
        board.emplace_back(25.0F * static_cast<float>(i % 9), 25.0F * static_cast<float>(i / 9), 0.0F);
    const auto calibrated = [&](const std::vector<std::vector<cv::Point2f>>& corners, double& rms_px) {
        cv::Mat k = cv::Mat::eye(3, 3, CV_64F), distortion;
        std::vector<cv::Mat> turns, ways;
        rms_px = cv::calibrateCamera(std::vector(corners.size(), board), corners, {640, 480}, k, distortion, turns,
                                     ways, cv::CALIB_FIX_ASPECT_RATIO);
        return k.at<double>(0, 0);
    };
    double rmsWide = 0.0, rmsFitting = 0.0;
    const double fWide = calibrated(wide, rmsWide), fFitting = calibrated(fitting, rmsFitting);
    MESSAGE("f " << fWide << " at " << rmsWide << " px rms; with windows that fit " << fFitting << " at "
                 << rmsFitting);
    CHECK(fWide == doctest::Approx(535.91573).epsilon(1e-4));
    CHECK(rmsWide == doctest::Approx(0.39259).epsilon(0.01));
    CHECK(fFitting == doctest::Approx(532.76).epsilon(0.0005));
    CHECK(rmsFitting < 0.21);
}

TEST_CASE(
    "board photos: a real scan's board is found, its corners lie where they lie on the projector, and one pose is "
    "refused") {
    const auto capture = realCapture();
    if (!capture) return;
    const Board board{9, 7, 75.0_mm};
    const auto view = boardView(capture->white, capture->decoded, board, "capture_0");
    REQUIRE_MESSAGE(view, view.error().what);
    const auto placed = std::ranges::count_if(view->onProjector, [](const auto& p) { return p.has_value(); });
    CHECK(placed >= 60);
    // Ground truth of another program, in OpenCV's pixels: the first and the last corner in the picture, and where one
    // homography of the board's plane puts them. (It counted 7 x 9 corners: its first is another corner of the board.)
    const std::array<Point<CameraFrame>, 2> inCamera{{{312.71 + 0.5, 690.5 + 0.5}, {884.38 + 0.5, 271.64 + 0.5}}};
    const std::array<Point<ProjectorFrame>, 2> onProjector{{{255.82 + 0.5, 589.0 + 0.5}, {586.70 + 0.5, 346.37 + 0.5}}};
    for (std::size_t k = 0; k < 2; ++k) {
        double nearest = 1e9;
        std::size_t at = 0;
        for (std::size_t i = 0; i < view->inCamera.size(); ++i) {
            const double d = std::hypot(view->inCamera[i].x - inCamera[k].x, view->inCamera[i].y - inCamera[k].y);
            if (d < nearest) nearest = d, at = i;
        }
        MESSAGE("corner " << k << ": off by " << nearest << " px in the picture");
        CHECK(nearest < 0.8);
        REQUIRE(view->onProjector[at]);
        const double dx = view->onProjector[at]->x - onProjector[k].x, dy = view->onProjector[at]->y - onProjector[k].y;
        MESSAGE("on the projector by " << dx << ", " << dy << " px");
        CHECK(std::hypot(dx, dy) < 1.0);
    }
    MESSAGE(placed << " corners placed, decoded pixels around them " << view->decoded_px << " px rms");
    CHECK(view->decoded_px < 0.6);

    const auto refused = calibrated(std::vector<BoardView>{*view}, board);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("One pose") != std::string::npos);
}
