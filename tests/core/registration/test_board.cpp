#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/registration/board.h"
#include "tests/core/registration/procam_truth.h"

namespace {

using namespace ilf;

/// The board photographed: squares where textbook's formulas put them, 4 x 4 samples a pixel, a little blur and noise.
/// Pixel (i, j) covers i to i + 1: what + 0.5 means is what is tested.
Image<std::uint8_t> photo(const truth::Lens& lens, const truth::BoardAt& at, const Board& board, double noise,
                          bool mirrored = false) {
    const auto pose = truth::poseOf(at, board);
    const Pose<ModelSpace, CameraSpace> back = pose.inverted();
    std::mt19937 random(11);
    std::normal_distribution<double> grain(0.0, noise > 0.0 ? noise : 1.0);
    const double s = board.square.si();
    constexpr int kSamples = 4;
    // Rays at the corners of pixels; within one they are as good as linear.
    const auto columns = static_cast<std::size_t>(lens.size.width) + 1;
    std::vector<std::array<double, 2>> rays;
    for (int y = 0; y <= lens.size.height; ++y)
        for (int x = 0; x <= lens.size.width; ++x)
            rays.push_back(truth::slopes(lens, mirrored ? lens.size.width - x : x, y));
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < lens.size.height; ++y) {
        for (int x = 0; x < lens.size.width; ++x) {
            double light = 0.0;
            const auto* ray = &rays[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)];
            for (int k = 0; k < kSamples * kSamples; ++k) {
                const double i = (k % kSamples + 0.5) / kSamples, j = (k / kSamples + 0.5) / kSamples;
                const double a = ray[0][0] + i * (ray[1][0] - ray[0][0]) + j * (ray[columns][0] - ray[0][0]);
                const double b = ray[0][1] + i * (ray[1][1] - ray[0][1]) + j * (ray[columns][1] - ray[0][1]);
                const auto& r = back.rotation;
                const auto& t = back.translation;
                const double z = -t[2] / (r[6] * a + r[7] * b + r[8]);
                const double u = (r[0] * a + r[1] * b + r[2]) * z + t[0], v = (r[3] * a + r[4] * b + r[5]) * z + t[1];
                const int column = static_cast<int>(std::floor(u / s)) + 1,
                          row = static_cast<int>(std::floor(v / s)) + 1;
                const bool inside = column >= 0 && row >= 0 && column <= board.columns && row <= board.rows;
                light += inside && (column + row) % 2 == 0 ? 25.0 : 190.0;
            }
            light /= kSamples * kSamples;
            if (noise > 0.0) light += grain(random);
            pixels.push_back(static_cast<std::uint8_t>(std::clamp(light, 0.0, 255.0)));
        }
    }
    return {lens.size, 1, std::move(pixels)};
}

truth::Lens halved(truth::Lens lens) {
    lens.size = {lens.size.width / 2, lens.size.height / 2};
    lens.fx /= 2, lens.fy /= 2, lens.cx /= 2, lens.cy /= 2;
    return lens;
}

/// From the true corners, the finder's two orders allowed: x right, y down errors, and their mean.
struct Off {
    double rms = 0.0, meanX = 0.0, meanY = 0.0;
};
template <class F>
Off off(std::vector<Point<F>> found, const std::vector<Point<F>>& truth) {
    const auto sum = [&] {
        Off o;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const double dx = found[i].x - truth[i].x, dy = found[i].y - truth[i].y;
            o.rms += (dx * dx + dy * dy) / static_cast<double>(truth.size());
            o.meanX += dx / static_cast<double>(truth.size()), o.meanY += dy / static_cast<double>(truth.size());
        }
        o.rms = std::sqrt(o.rms);
        return o;
    };
    const Off once = sum();
    std::ranges::reverse(found);
    const Off reversed = sum();
    return once.rms < reversed.rms ? once : reversed;
}

}  // namespace

TEST_CASE("chessboard: corners of a photographed board lie where they are, half a pixel not forgotten") {
    truth::Procam procam;
    const truth::Lens lens = halved(procam.camera);
    procam.camera = lens;
    std::mt19937 random(1);
    for (const truth::BoardAt& at :
         {truth::fivePoses()[0], truth::fivePoses()[1], truth::BoardAt{10, 48, 5, 0, 0, 1}}) {
        const auto found = boardCorners(photo(lens, at, truth::kBoard, 2.0), truth::kBoard, "pose");
        REQUIRE_MESSAGE(found, found.error().what);
        const Off o = off(*found, truth::viewOf(procam, at, truth::kBoard, 0.0, 0.0, random).inCamera);
        MESSAGE("corners off by " << o.rms << " px rms, mean " << o.meanX << ", " << o.meanY);
        CHECK(o.rms < 0.12);
        CHECK(std::abs(o.meanX) < 0.05);
        CHECK(std::abs(o.meanY) < 0.05);
    }
}

TEST_CASE("chessboard: rows follow columns the same way round, on their head and through a mirror as well") {
    const truth::Procam procam;
    const truth::Lens lens = halved(procam.camera);
    const auto handed = [](const std::vector<Point<CameraFrame>>& c) {
        const auto &a = c[0], &along = c[8], &down = c[54];
        return (along.x - a.x) * (down.y - a.y) - (along.y - a.y) * (down.x - a.x) > 0.0;
    };
    for (const double turn : {0.0, 90.0, 180.0}) {
        const auto found =
            boardCorners(photo(lens, {8, 8, turn, 0, 0, 1.1}, truth::kBoard, 0.0), truth::kBoard, "pose");
        REQUIRE_MESSAGE(found, found.error().what);
        CHECK(handed(*found));
    }
    const auto mirrored = boardCorners(photo(lens, {8, 8, 0, 0, 0, 1.1}, truth::kBoard, 0.0, true), truth::kBoard, "");
    REQUIRE(mirrored);
    CHECK(handed(*mirrored));
}

TEST_CASE("chessboard: none, another one and a board without a size are refused in words") {
    const truth::Procam procam;
    const truth::Lens lens = halved(procam.camera);
    const auto picture = photo(lens, {0, 0, 0, 0, 0, 1}, truth::kBoard, 0.0);
    const auto other = boardCorners(picture, {12, 9, 25.0_mm}, "capture_3");
    REQUIRE_FALSE(other);
    CHECK(other.error().what.find("capture_3: no chessboard of 12 x 9 inner corners is seen") != std::string::npos);
    CHECK_FALSE(boardCorners(picture, {2, 9, 25.0_mm}, "pose"));
    CHECK_FALSE(boardCorners(picture, {9, 7, 0.0_m}, "pose"));
    CHECK_FALSE(boardCorners({}, truth::kBoard, "pose"));
}

TEST_CASE(
    "chessboard on the projector: corners are placed through noise, whole squares that are holes, and wrong codes") {
    const truth::Procam procam;
    const truth::BoardAt at{20, -15, 4, 0.0, 0.0, 1.0};
    std::mt19937 random(2);
    const BoardView exact = truth::viewOf(procam, at, truth::kBoard, 0.0, 0.0, random);
    // The plane of the board as z = depth + slopeX x + slopeY y.
    const auto pose = truth::poseOf(at, truth::kBoard);
    const double nx = pose.rotation[2], ny = pose.rotation[5], nz = pose.rotation[8];
    const auto& t = pose.translation;
    const double depth = (nx * t[0] + ny * t[1] + nz * t[2]) / nz;
    std::vector<double> truth;
    const DecodedScan clean = truth::scanOf(procam, depth, -nx / nz, -ny / nz, 0.3, 5, truth);

    // Black squares are not decoded; one pixel in seven has a wrong bit.
    const Size size = procam.camera.size;
    std::vector<float> places(clean.projectorOfCamera.pixels().begin(), clean.projectorOfCamera.pixels().end());
    std::vector<std::uint8_t> confidence(clean.confidence.pixels().begin(), clean.confidence.pixels().end());
    const auto back = pose.inverted();
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const auto i = static_cast<std::size_t>(y * size.width + x);
            if (truth[i] == 0.0) continue;
            const auto [a, b] = truth::slopes(procam.camera, x + 0.5, y + 0.5);
            const auto p = back(Point3<CameraSpace>{a * truth[i], b * truth[i], truth[i]});
            const int column = static_cast<int>(std::floor(p.x / 0.055)),
                      row = static_cast<int>(std::floor(p.y / 0.055));
            if ((column + row) % 2 == 0) confidence[i] = 0;
            if (random() % 7 == 0) places[2 * i + random() % 2] += static_cast<float>(1 << (2 + random() % 7));
        }
    }
    DecodedScan holed = clean;
    holed.projectorOfCamera = Image<float>(size, 2, std::move(places));
    holed.confidence = Image<std::uint8_t>(size, 1, std::move(confidence));
    const auto view = boardView(exact.inCamera, holed, truth::kBoard, "pose");
    REQUIRE_MESSAGE(view, view.error().what);
    std::vector<Point<ProjectorFrame>> found, wanted;
    for (std::size_t i = 0; i < view->onProjector.size(); ++i) {
        if (!view->onProjector[i]) continue;
        found.push_back(*view->onProjector[i]), wanted.push_back(*exact.onProjector[i]);
    }
    const Off o = off(found, wanted);
    MESSAGE(found.size() << " of 63 corners, off by " << o.rms << " px rms; pixels " << view->decoded_px << " px");
    CHECK(found.size() >= 56);  // those in the picture's and the raster's inner part
    CHECK(o.rms < 0.06);
    CHECK(view->decoded_px == doctest::Approx(0.42).epsilon(0.15));

    DecodedScan dark = clean;
    dark.confidence = Image<std::uint8_t>(size, 1, std::vector<std::uint8_t>(truth.size(), 0));
    const auto refused = boardView(exact.inCamera, dark, truth::kBoard, "capture_2");
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("capture_2: the scan says where only 0 of the board's 63 corners") !=
          std::string::npos);
}
