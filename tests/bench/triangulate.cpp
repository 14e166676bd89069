// How long triangulation takes for a scan of 1280 x 1024 pixels, and how wrong its depth is.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "core/registration/triangulate.h"
#include "tests/core/registration/procam_truth.h"

namespace {

using namespace ilf;

void depthFromScan(benchmark::State& state) {
    truth::Procam procam;
    if (state.range(0) != 0) {  // lit as a whole
        procam.projector.fx *= 0.45, procam.projector.fy *= 0.45;
        procam.projector.cx = 512.0, procam.projector.cy = 560.0;
    }
    constexpr double kNoise_px = 0.1;
    std::vector<double> truth;
    const DecodedScan scan = truth::scanOf(procam, 1.0, 0.1, 0.05, kNoise_px, 5, truth);
    const ProcamCalibration calibration = procam.calibration();
    TriangulateOptions options;
    options.match_px = kNoise_px;
    options.common = 0.0;
    Result<Triangulated> found = triangulated(scan, calibration, options);
    for (auto _ : state) {
        found = triangulated(scan, calibration, options);
        benchmark::DoNotOptimize(found);
    }
    double share2 = 0.0, sigma2 = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double z = static_cast<double>(found->depth.metres.pixels()[i]);
        if (z == 0.0) continue;
        share2 += std::pow((z - truth[i]) / truth[i], 2);
        sigma2 += std::pow((z - truth[i]) / static_cast<double>(found->depth.sigma.pixels()[i]), 2);
    }
    state.counters["pixels"] = found->measured;
    state.counters["error_percent"] = 100.0 * std::sqrt(share2 / found->measured);
    state.counters["error_sigmas"] = std::sqrt(sigma2 / found->measured);
}

/// OpenCV's way: both places undistorted, all rays crossed by singular values.
void depthByOpenCv(benchmark::State& state) {
    const truth::Procam procam;
    std::vector<double> truth;
    const DecodedScan scan = truth::scanOf(procam, 1.0, 0.1, 0.05, 0.1, 5, truth);
    const ProcamCalibration c = procam.calibration();
    const auto matrix = [](const Pinhole& p) { return cv::Matx33d(p.fx, 0, p.cx - 0.5, 0, p.fy, p.cy - 0.5, 0, 0, 1); };
    const auto distortion = [](const Pinhole& p) { return std::vector(p.distortion.begin(), p.distortion.end()); };
    const auto& r = c.projectorFromCamera.rotation;
    const auto& t = c.projectorFromCamera.translation;
    const cv::Matx34d first(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    const cv::Matx34d second(r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]);
    std::vector<cv::Point2d> camera, raster;
    std::vector<std::size_t> pixel;
    cv::Mat points;
    for (auto _ : state) {
        camera.clear(), raster.clear(), pixel.clear();
        for (int y = 0; y < scan.confidence.height(); ++y) {
            for (int x = 0; x < scan.confidence.width(); ++x) {
                if (scan.confidence.at(x, y) == 0) continue;
                camera.emplace_back(x, y);
                raster.emplace_back(static_cast<double>(scan.projectorOfCamera.at(x, y, 0)) - 0.5,
                                    static_cast<double>(scan.projectorOfCamera.at(x, y, 1)) - 0.5);
                pixel.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(scan.confidence.width()) +
                                static_cast<std::size_t>(x));
            }
        }
        std::vector<cv::Point2d> a, b;
        cv::undistortPoints(camera, a, matrix(c.camera), distortion(c.camera));
        cv::undistortPoints(raster, b, matrix(c.projector), distortion(c.projector));
        cv::triangulatePoints(first, second, a, b, points);
    }
    double share2 = 0.0;
    for (std::size_t i = 0; i < pixel.size(); ++i) {
        const int column = static_cast<int>(i);
        const double z = points.at<double>(2, column) / points.at<double>(3, column);
        share2 += std::pow((z - truth[pixel[i]]) / truth[pixel[i]], 2);
    }
    state.counters["pixels"] = static_cast<double>(pixel.size());
    state.counters["error_percent"] = 100.0 * std::sqrt(share2 / static_cast<double>(pixel.size()));
}
BENCHMARK(depthByOpenCv)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

BENCHMARK(depthFromScan)->ArgName("whole")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
