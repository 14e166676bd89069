// Decoding a Gray-code scan: time and error, ours beside OpenCV's decoder on the same pictures in the same run.
//
// The pictures are kamino410's real capture (IF_TEST_DATA or ../shared/data) of 1280 x 1024 pixels; where it is absent,
// a made-up camera takes them, and the output says so. Error: distance on the raster from the homography that fits all
// pixels compared (on the real capture those on the chessboard, which is flat; made up: from the truth), rms of those
// within 2 px.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/structured_light.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/registration/gray_code.h"
#include "core/registration/scan_diagnosis.h"
#include "projects/scan_folder.h"
#include "tests/support/synthetic_scan.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;

const Size kProjector{1024, 768};

struct Input {
    Scan scan;       ///< in OpenCV's order
    cv::Mat inside;  ///< of what is compared
    bool real = false;
};

const Input& input() {
    static const Input given = [] {
        Input out;
        const auto folder = testData("03_procam/kamino410/capture_0");
        const auto scan = folder ? projects::readScan(*folder, kProjector) : Result<Scan>(fail(Fault::notFound, ""));
        if (scan) {
            out.real = true;
            out.scan = *scan;
        } else {
            std::printf("SYNTHETIC PICTURES: the real capture is absent; errors below say nothing about real light.\n");
            SyntheticCamera at;
            at.camera = {1280, 1024};
            at.projector = kProjector;
            at.samples = 3;
            at.noise = 2.0;
            at.look = [](double x, double y) { return std::array{0.594 * x + 66.0, 0.56 * y + 190.0}; };
            const Looks looks = looksOf(at);
            out.scan = {kProjector, projects::openCvPatterns(kProjector), {}};
            unsigned seed = 1;
            for (const Pattern& pattern : out.scan.patterns)
                out.scan.pictures.push_back(photographed(at, looks, pattern, seed++));
        }
        const auto& white = out.scan.pictures[40];
        const cv::Mat view(white.height(), white.width(), CV_8U, const_cast<std::uint8_t*>(white.pixels().data()));
        out.inside = cv::Mat(view.size(), CV_8U, cv::Scalar(out.real ? 0 : 255));
        std::vector<cv::Point2f> corners, hull;
        if (out.real && cv::findChessboardCorners(view, {7, 9}, corners)) {
            cv::convexHull(corners, hull);
            cv::fillConvexPoly(out.inside, std::vector<cv::Point>(hull.begin(), hull.end()), 255);
        }
        return out;
    }();
    return given;
}

/// Where on the raster a pixel looks, or nothing.
using Places = std::function<std::optional<cv::Point2d>(int x, int y)>;

void judge(benchmark::State& state, const Places& places) {
    std::vector<cv::Point2d> from, to, on;
    const cv::Mat& inside = input().inside;
    for (int y = 0; y < inside.rows; ++y) {
        for (int x = 0; x < inside.cols; ++x) {
            if (inside.at<std::uint8_t>(y, x) == 0) continue;
            if (const auto place = places(x, y)) {
                from.emplace_back(x + 0.5, y + 0.5);
                to.push_back(*place);
            }
        }
    }
    // Two rounds, so that a few codes that are far off do not tilt the plane.
    cv::Mat plane = cv::findHomography(from, to, cv::RANSAC, 2.0);
    std::vector<cv::Point2d> fitFrom, fitTo;
    cv::perspectiveTransform(from, on, plane);
    for (std::size_t i = 0; i < on.size(); ++i) {
        if (cv::norm(on[i] - to[i]) > 2.0) continue;
        fitFrom.push_back(from[i]);
        fitTo.push_back(to[i]);
    }
    plane = cv::findHomography(fitFrom, fitTo);
    cv::perspectiveTransform(from, on, plane);
    double squares = 0.0;
    std::size_t near = 0;
    for (std::size_t i = 0; i < on.size(); ++i) {
        const double off = cv::norm(on[i] - to[i]);
        if (off > 2.0) continue;
        ++near;
        squares += off * off;
    }
    state.counters["decoded_pct"] = 100.0 * double(from.size()) / cv::countNonZero(inside);
    state.counters["within_2px_pct"] = 100.0 * double(near) / double(std::max<std::size_t>(1, from.size()));
    state.counters["rms_px"] = std::sqrt(squares / double(std::max<std::size_t>(1, near)));
    state.counters["real"] = input().real ? 1.0 : 0.0;
}

void decodeOurs(benchmark::State& state) {
    const Scan& scan = input().scan;
    auto decoded = decodedScan(scan);
    for (auto _ : state)
        decoded = decodedScan(scan);
    judge(state, [&](int x, int y) -> std::optional<cv::Point2d> {
        if (decoded->confidence.at(x, y) == 0) return std::nullopt;
        return cv::Point2d(decoded->projectorOfCamera.at(x, y, 0), decoded->projectorOfCamera.at(x, y, 1));
    });
}
BENCHMARK(decodeOurs)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(1.0);

/// Pixel by pixel, as its users do (graycode-procam and others); thresholds: white above black, bit above inverse.
void decodeOpenCv(benchmark::State& state) {
    const Scan& scan = input().scan;
    std::vector<cv::Mat> pictures;
    for (const auto& picture : scan.pictures)
        pictures.emplace_back(picture.height(), picture.width(), CV_8U,
                              const_cast<std::uint8_t*>(picture.pixels().data()));
    const cv::Mat white = pictures[40], black = pictures[41];
    pictures.resize(40);
    const auto decoder = cv::structured_light::GrayCodePattern::create(kProjector.width, kProjector.height);
    const int lit = static_cast<int>(state.range(0));
    decoder->setBlackThreshold(static_cast<std::size_t>(lit));
    decoder->setWhiteThreshold(static_cast<std::size_t>(state.range(1)));
    cv::Mat places;
    for (auto _ : state) {
        places = cv::Mat(white.size(), CV_32SC2, cv::Scalar(-1, -1));
        for (int y = 0; y < white.rows; ++y) {
            for (int x = 0; x < white.cols; ++x) {
                cv::Point at;
                if (white.at<std::uint8_t>(y, x) - black.at<std::uint8_t>(y, x) <= lit) continue;
                if (!decoder->getProjPixel(pictures, x, y, at)) places.at<cv::Vec2i>(y, x) = {at.x, at.y};
            }
        }
    }
    judge(state, [&](int x, int y) -> std::optional<cv::Point2d> {
        const auto at = places.at<cv::Vec2i>(y, x);
        if (at[0] < 0) return std::nullopt;
        return cv::Point2d(at[0] + 0.5, at[1] + 0.5);
    });
}
BENCHMARK(decodeOpenCv)
    ->Args({40, 5})
    ->Args({5, 5})
    ->Args({5, 2})
    ->Args({5, 0})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void mapBothWays(benchmark::State& state) {
    const auto decoded = decodedScan(input().scan);
    for (auto _ : state)
        benchmark::DoNotOptimize(denseMap(*decoded));
}
BENCHMARK(mapBothWays)->Unit(benchmark::kMillisecond)->UseRealTime();

void diagnosis(benchmark::State& state) {
    const auto decoded = decodedScan(input().scan);
    for (auto _ : state)
        benchmark::DoNotOptimize(scanDiagnosis(input().scan, *decoded));
}
BENCHMARK(diagnosis)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
