// What following costs in a 1280x720 frame, and how far off its corners are; beside it OpenCV's own search of the whole
// frame for the same marker.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/document/shape.h"
#include "core/track/marker.h"
#include "core/track/moved_mask.h"
#include "core/track/planar.h"
#include "tests/core/track/drawn_marker.h"

namespace ilf {

namespace {

constexpr Size kFrame{1280, 720};
constexpr int kFrames = 12;

Quad placed(int frame) {
    const double angle = 0.03 * frame, side = 90.0;
    const double c = side * std::cos(angle), s = side * std::sin(angle);
    const double x = 500.3 + 9.7 * frame, y = 250.6 + 4.1 * frame;
    return {{{x, y}, {x + c, y + s}, {x + c - s, y + s + c}, {x - s, y + c}}};
}

/// A marker that moves over a busy ground.
const std::vector<Image<std::uint8_t>>& markerFrames() {
    static const auto frames = [] {
        std::vector<Image<std::uint8_t>> made;
        for (int i = 0; i < kFrames; ++i) {
            DrawnScene scene;
            scene.size = kFrame;
            scene.noise = 3.0;
            scene.seed = static_cast<unsigned>(i + 1);
            const auto plain = drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 7, placed(i));
            std::vector<std::uint8_t> v(plain.pixels().begin(), plain.pixels().end());
            const auto keep = boxAround(placed(i)).grown(20);
            cv::Mat view(kFrame.height, kFrame.width, CV_8UC1, v.data());
            cv::RNG random(5);
            for (int k = 0; k < 300; ++k) {  // things on a desk
                const cv::Rect thing(random.uniform(0, 1240), random.uniform(0, 690), random.uniform(8, 120),
                                     random.uniform(8, 90));
                const cv::Rect marker(keep.x0, keep.y0, keep.width(), keep.height());
                if ((thing & marker).empty())
                    cv::rectangle(view, thing, cv::Scalar(random.uniform(30, 220)), k % 3 == 0 ? 2 : cv::FILLED);
            }
            made.emplace_back(kFrame, 1, std::move(v));
        }
        return made;
    }();
    return frames;
}

struct Offs {
    double sum = 0.0, most = 0.0;
    int seen = 0, asked = 0;
    void add(const Quad& truth, const Quad& found) {
        const double off = farthestCorner(truth, found);
        sum += off;
        most = std::max(most, off);
        ++seen;
    }
    void report(benchmark::State& state) const {
        state.counters["seen"] = static_cast<double>(seen) / std::max(1, asked);
        state.counters["worst_corner_mean_px"] = sum / std::max(1, seen);
        state.counters["worst_corner_px"] = most;
    }
};

void search(benchmark::State& state, const MarkerSearch& how, bool windowed) {
    cv::setNumThreads(1);
    const auto& frames = markerFrames();
    Offs offs;
    int i = 0;
    for (auto _ : state) {
        const int frame = i++ % kFrames;
        auto search = how;
        if (windowed) search.window = boxAround(placed(std::max(0, frame - 1))).grown(40);  // as predicted, badly
        const auto seen = findMarkers(frames[static_cast<std::size_t>(frame)], search);
        ++offs.asked;
        if (seen && seen->size() == 1) offs.add(placed(frame), seen->front().corners);
    }
    offs.report(state);
}

void markerInWindow(benchmark::State& state) { search(state, {"APRILTAG_36h11", {7}, {}, 1}, true); }
void markerInWholeFrameAtHalfSize(benchmark::State& state) { search(state, {"APRILTAG_36h11", {7}, {}, 2}, false); }
void markerInWholeFrame(benchmark::State& state) { search(state, {"APRILTAG_36h11", {7}, {}, 1}, false); }

/// A lost marker: each picture's part of the search, all twelve of them in turn. `worst_ms`: the longest of them.
void markerLostPart(benchmark::State& state) {
    cv::setNumThreads(1);
    const auto& frames = markerFrames();
    constexpr std::size_t kParts = 12;
    std::array<double, kParts> least{};
    least.fill(1e9);
    Offs offs;
    std::size_t i = 0;
    for (auto _ : state) {
        const std::size_t part = i % kParts, frame = i / kParts % kFrames;
        ++i;
        const auto start = std::chrono::steady_clock::now();
        const auto seen =
            findMarkers(frames[frame], partOfSearch({"APRILTAG_36h11", {7}, {}, 1}, kFrame, static_cast<int>(part)));
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        least[part] = std::min(least[part], took.count());
        ++offs.asked;
        if (seen && seen->size() == 1) offs.add(placed(static_cast<int>(frame)), seen->front().corners);
    }
    offs.report(state);
    state.counters["worst_ms"] = *std::ranges::max_element(least);
}

void openCvInWholeFrame(benchmark::State& state) {
    cv::setNumThreads(1);
    const auto& frames = markerFrames();
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
    auto parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    parameters->minMarkerDistanceRate = 0.015;  // by default it takes the edge of the white rim for the marker's
    Offs offs;
    int i = 0;
    for (auto _ : state) {
        const int frame = i++ % kFrames;
        const auto& grey = frames[static_cast<std::size_t>(frame)];
        const cv::Mat view(kFrame.height, kFrame.width, CV_8UC1, const_cast<std::uint8_t*>(grey.pixels().data()));
        std::vector<std::vector<cv::Point2f>> corners;
        std::vector<int> ids;
        cv::aruco::detectMarkers(view, dictionary, corners, ids, parameters);
        ++offs.asked;
        for (std::size_t m = 0; m < ids.size(); ++m) {
            if (ids[m] != 7) continue;
            Quad q;
            for (std::size_t k = 0; k < 4; ++k)
                q[k] = {static_cast<double>(corners[m][k].x) + 0.5, static_cast<double>(corners[m][k].y) + 0.5};
            offs.add(placed(frame), q);
        }
    }
    offs.report(state);
}

/// A printed page of blots, drawn anew for each place with 2 x 2 samples a pixel.
Image<std::uint8_t> page(const Motion& motion, unsigned seed) {
    cv::Mat print(360, 480, CV_8UC1, cv::Scalar(215));
    cv::RNG blots(3);
    for (int k = 0; k < 260; ++k)
        cv::rectangle(
            print, cv::Rect(blots.uniform(0, 465), blots.uniform(0, 350), blots.uniform(3, 26), blots.uniform(3, 14)),
            cv::Scalar(blots.uniform(20, 200)), cv::FILLED);
    cv::GaussianBlur(print, print, {3, 3}, 0.7);
    const cv::Matx33d place(1, 0, 400.5, 0, 1, 180.5, 0, 0, 1), to(1, 0, -0.5, 0, 1, -0.5, 0, 0, 1);
    cv::Mat frame;
    cv::warpPerspective(print, frame, to * cv::Matx33d(motion.m.data()) * place, {kFrame.width, kFrame.height},
                        cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(120));
    cv::Mat noise(frame.size(), CV_16S);
    cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, 3);
    frame.convertTo(frame, CV_16S);
    frame += noise;
    frame.convertTo(frame, CV_8U);
    return {kFrame, 1, std::vector<std::uint8_t>(frame.datastart, frame.dataend)};
}

Motion swayed(int i) {
    const double angle = 0.02 * i, c = std::cos(angle), s = std::sin(angle);
    return {{c, -s, 3.3 * i + 360 * s, s, c, 1.7 * i - 160 * s, 2e-5 * i, 0, 1}};
}

const std::vector<Image<std::uint8_t>>& pages() {
    static const auto frames = [] {
        std::vector<Image<std::uint8_t>> made;
        for (int i = 0; i < kFrames; ++i)
            made.push_back(page(swayed(i), static_cast<unsigned>(i + 1)));
        return made;
    }();
    return frames;
}

/// `anywhere`: all looks of a search in one picture.
void planar(benchmark::State& state, bool anywhere) {
    cv::setNumThreads(1);
    const auto& frames = pages();
    const auto pattern = planarPattern(frames[0], {400, 180, 880, 540});
    if (!pattern) return state.SkipWithError(pattern.error().what.c_str());
    const Quad corners = cornersOf((*pattern)->patch);
    Offs offs;
    int i = 0;
    for (auto _ : state) {
        const int frame = i++ % kFrames;
        const auto& grey = frames[static_cast<std::size_t>(frame)];
        std::optional<SeenPlanar> seen;
        PlanarSearch search;
        if (!anywhere) seen = followPlanar(**pattern, grey, swayed(std::max(0, frame - 1)));
        for (int look = 0; anywhere && look < PlanarSearch::kLooks; ++look)
            seen = lookedFor(search, **pattern, grey);
        ++offs.asked;
        if (seen) offs.add(moved(corners, swayed(frame)), moved(corners, seen->motion));
    }
    offs.report(state);
}

/// A lost flat thing: each picture's look of the search, while it sways on. `worst_ms`: the longest of them.
void planarLostLook(benchmark::State& state) {
    cv::setNumThreads(1);
    const auto& frames = pages();
    const auto pattern = planarPattern(frames[0], {400, 180, 880, 540});
    if (!pattern) return state.SkipWithError(pattern.error().what.c_str());
    const Quad corners = cornersOf((*pattern)->patch);
    std::array<double, PlanarSearch::kLooks> least{};
    least.fill(1e9);
    Offs offs;
    PlanarSearch search;
    int i = 0;
    for (auto _ : state) {
        const int frame = i++ % kFrames;
        const auto look = static_cast<std::size_t>(search.look);
        const auto start = std::chrono::steady_clock::now();
        const auto seen = lookedFor(search, **pattern, frames[static_cast<std::size_t>(frame)]);
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        least[look] = std::min(least[look], took.count());
        offs.asked += look == PlanarSearch::kLooks - 1 ? 1 : 0;
        if (seen) offs.add(moved(corners, swayed(frame)), moved(corners, seen->motion));
    }
    offs.report(state);
    state.counters["worst_ms"] = *std::ranges::max_element(least);
}

void planarFollowed(benchmark::State& state) { planar(state, false); }
void planarFoundAnywhere(benchmark::State& state) { planar(state, true); }

void movedMask(benchmark::State& state) {
    const Mask mask = rasterised(Ellipse{{400, 180}, {880, 540}}, kFrame);
    Mask last;
    int i = 0;
    for (auto _ : state) {
        last = moved(mask, swayed(1 + i++ % (kFrames - 1)), last.empty() ? nullptr : &last);
        benchmark::DoNotOptimize(last);
    }
}

BENCHMARK(markerInWindow)->Unit(benchmark::kMillisecond);
BENCHMARK(markerLostPart)->Unit(benchmark::kMillisecond);
BENCHMARK(markerInWholeFrameAtHalfSize)->Unit(benchmark::kMillisecond);
BENCHMARK(markerInWholeFrame)->Unit(benchmark::kMillisecond);
BENCHMARK(openCvInWholeFrame)->Unit(benchmark::kMillisecond);
BENCHMARK(planarLostLook)->Unit(benchmark::kMillisecond);
BENCHMARK(planarFollowed)->Unit(benchmark::kMillisecond);
BENCHMARK(planarFoundAnywhere)->Unit(benchmark::kMillisecond);
BENCHMARK(movedMask)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace ilf

BENCHMARK_MAIN();
