// What the window does with a scene while it is used: a surface by a click, a look whether the camera was bumped, a
// frame of the emulated camera. Each beside a plain way of doing it, on the same data in the same run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <random>
#include <vector>

#include "core/document/select_depth.h"
#include "core/registration/bump.h"
#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/light_transport.h"
#include "devices/emulated_scene/sensor.h"

namespace {

using namespace ilf;

// --- A surface by a click: a wall that stands on a desk, with a crease between them and no step; noise as of a depth
// camera.

constexpr Size kDepth{640, 480};
bool onWall(int, int y) { return y <= 270; }

const DepthMap& desk() {
    static const DepthMap made = [] {
        std::mt19937 random(11);
        std::normal_distribution<double> off_D(0.0, 0.0005);
        std::vector<float> metres;
        for (int y = 0; y < kDepth.height; ++y) {
            for (int x = 0; x < kDepth.width; ++x) {
                const double vergence = 0.8 + (onWall(x, y) ? 0.0 : 0.006 * (y - 270));
                metres.push_back(static_cast<float>(1.0 / (vergence + off_D(random))));
            }
        }
        return DepthMap{{kDepth, 1, std::move(metres)}, {}, {}};
    }();
    return made;
}

/// Percent of the pixels of either on which the two disagree.
void judge(benchmark::State& state, const std::function<double(int, int)>& found) {
    double both = 0.0, either = 0.0;
    for (int y = 0; y < kDepth.height; ++y) {
        for (int x = 0; x < kDepth.width; ++x) {
            const double m = found(x, y), t = onWall(x, y) ? 1.0 : 0.0;
            both += std::min(m, t);
            either += std::max(m, t);
        }
    }
    state.counters["error"] = 100.0 * (1.0 - both / either);
    state.SetLabel("% of pixels that it has wrong");
}

void selectByDepth(benchmark::State& state) {
    const Picture picture(kDepth, 1, std::vector<std::uint16_t>(std::size_t{640} * 480, 30000));
    auto mask = surfaceAt(desk(), picture, {320.5, 140.5});
    for (auto _ : state)
        benchmark::DoNotOptimize(mask = surfaceAt(desk(), picture, {320.5, 140.5}));
    if (!mask) return state.SkipWithError(mask.error().what.c_str());
    judge(state, [&](int x, int y) { return mask->at(x, y) / 255.0; });
}
BENCHMARK(selectByDepth)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A flood of neighbours that differ by less than 2 % of the clicked depth.
void selectFlood(benchmark::State& state) {
    const cv::Mat depth(kDepth.height, kDepth.width, CV_32F, const_cast<float*>(desk().metres.pixels().data()));
    cv::Mat mask;
    const auto most = cv::Scalar(0.02 * static_cast<double>(depth.at<float>(140, 320)));
    for (auto _ : state) {
        mask = cv::Mat::zeros(kDepth.height + 2, kDepth.width + 2, CV_8U);
        cv::floodFill(depth, mask, {320, 140}, 0, nullptr, most, most, 4 | (255 << 8) | cv::FLOODFILL_MASK_ONLY);
    }
    judge(state, [&](int x, int y) { return mask.at<std::uint8_t>(y + 1, x + 1) / 255.0; });
}
BENCHMARK(selectFlood)->Unit(benchmark::kMillisecond)->UseRealTime();

// --- Whether the camera was bumped: it turned by half a degree about its axis and shifted, the light is a third less,
// and a hand is in the way.

const cv::Matx33d kBump{0.99996, -0.0087, 9.4, 0.0087, 0.99996, -4.2, 0, 0, 1};

cv::Mat seenFrom(const cv::Matx33d& motion, bool later) {
    cv::Mat table(720, 1280, CV_8U, cv::Scalar(120)), seen, noise(table.size(), CV_16S), sum;
    cv::RNG random(3);
    for (int i = 0; i < 500; ++i) {
        const cv::Point at(random.uniform(0, 1280), random.uniform(0, 720));
        const cv::Size size(random.uniform(5, 65), random.uniform(5, 45));
        cv::rectangle(table, {at, size}, cv::Scalar(random.uniform(30, 230)), cv::FILLED);
    }
    cv::GaussianBlur(table, table, {3, 3}, 0.8);
    cv::warpPerspective(table, seen, motion, table.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    cv::RNG(later ? 2 : 1).fill(noise, cv::RNG::NORMAL, 0, 3);
    seen.convertTo(sum, CV_16S, later ? 0.67 : 1.0);
    sum += noise;
    sum.convertTo(seen, CV_8U);
    if (later) cv::rectangle(seen, cv::Rect(300, 200, 200, 520), cv::Scalar(90), cv::FILLED);
    return seen;
}

Image<std::uint8_t> imageOf(const cv::Mat& grey) {
    return {{grey.cols, grey.rows}, 1, std::vector<std::uint8_t>(grey.datastart, grey.dataend)};
}

/// The farthest that corners of the picture are from where they truly are, pixels with their centres on whole numbers.
void judge(benchmark::State& state, const std::function<cv::Point2d(double, double)>& found) {
    double worst = 0.0;
    for (const double x : {0.0, 1279.0}) {
        for (const double y : {0.0, 719.0}) {
            const cv::Vec3d truth = kBump * cv::Vec3d(x, y, 1.0);
            worst = std::max(worst, cv::norm(found(x, y) - cv::Point2d(truth[0], truth[1])));
        }
    }
    state.counters["error"] = worst;
    state.SetLabel("px, the farthest corner of the picture");
}

void bumpCheck(benchmark::State& state) {
    cv::setNumThreads(1);
    const auto alarm = BumpAlarm::of(imageOf(seenFrom(cv::Matx33d::eye(), false)));
    if (!alarm) return state.SkipWithError(alarm.error().what.c_str());
    const auto now = imageOf(seenFrom(kBump, true));
    auto report = alarm->compared(now);
    for (auto _ : state)
        benchmark::DoNotOptimize(report = alarm->compared(now));
    if (!report || !report->newFromOld) return state.SkipWithError("the bump was not noticed");
    judge(state, [&](double x, double y) {
        const auto p = (*report->newFromOld)(Point<CameraFrame>{x + 0.5, y + 0.5});
        return cv::Point2d(p.x - 0.5, p.y - 0.5);
    });
}
BENCHMARK(bumpCheck)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Corners of the reference followed by optical flow, and a homography through them: what a first program would do.
void bumpFlow(benchmark::State& state) {
    cv::setNumThreads(1);
    const cv::Mat before = seenFrom(cv::Matx33d::eye(), false), now = seenFrom(kBump, true);
    std::vector<cv::Point2f> from, to;
    cv::goodFeaturesToTrack(before, from, 500, 0.01, 12);
    cv::Mat plane;
    for (auto _ : state) {
        std::vector<std::uint8_t> found;
        cv::calcOpticalFlowPyrLK(before, now, from, to, found, cv::noArray(), {21, 21}, 4);
        std::vector<cv::Point2f> a, b;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == 0) continue;
            a.push_back(from[i]);
            b.push_back(to[i]);
        }
        plane = cv::findHomography(a, b, cv::RANSAC, 1.5);
    }
    judge(state, [&](double x, double y) {
        const cv::Mat p = plane * (cv::Mat_<double>(3, 1) << x, y, 1.0);
        return cv::Point2d(p.at<double>(0) / p.at<double>(2), p.at<double>(1) / p.at<double>(2));
    });
}
BENCHMARK(bumpFlow)->Unit(benchmark::kMillisecond)->UseRealTime();

// --- A frame of the emulated camera: light through a transport that is worked out once, beside the rays anew.

constexpr Size kRaster{1024, 768};

const devices::scene::LightTransport& transport() {
    static const devices::scene::LightTransport made(devices::scene::builtInStage(kRaster));
    return made;
}

/// Squares of 16 pixels.
const std::vector<float>& light() {
    static const std::vector<float> made = [] {
        std::vector<float> squares;
        for (int y = 0; y < kRaster.height; ++y) {
            for (int x = 0; x < kRaster.width; ++x)
                squares.push_back((x / 16 + y / 16) % 2 == 0 ? 1.0F : 0.0F);
        }
        return squares;
    }();
    return made;
}

void emulatedFrame(benchmark::State& state) {
    std::vector<float> lux;
    transport().shine(light(), 15.0, lux);  // rays are cast before the first frame, once
    devices::scene::SensorSettings sensor;
    Image<std::uint8_t> frame;
    for (auto _ : state) {
        sensor.seed += 1;
        transport().shine(light(), 15.0, lux);
        benchmark::DoNotOptimize(frame = devices::scene::exposed(transport(), lux, sensor));
    }
    state.counters["pixels"] = static_cast<double>(frame.width()) * frame.height();
    state.SetLabel("1280 x 1024");
}
BENCHMARK(emulatedFrame)->Unit(benchmark::kMillisecond)->UseRealTime();

/// What each frame would cost if its rays were cast anew.
void emulatedRays(benchmark::State& state) {
    std::vector<float> lux;
    for (auto _ : state) {
        const devices::scene::LightTransport again(transport().stage());
        again.shine(light(), 15.0, lux);
        benchmark::DoNotOptimize(devices::scene::exposed(again, lux, {}));
    }
}
BENCHMARK(emulatedRays)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
