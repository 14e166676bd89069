// What a brush stroke costs before anything is compiled: a dab into the document, undo, a snapshot; beside each, the
// cost of the whole frame, to show what was skipped.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/document/edit.h"
#include "core/document/history.h"

namespace ilf {

namespace {

using Clock = std::chrono::steady_clock;

/// Times each call on its own and reports p50 and p95 in microseconds.
class Percentiles {
public:
    explicit Percentiles(benchmark::State& state) : state_(state) {}
    ~Percentiles() {
        std::sort(microseconds_.begin(), microseconds_.end());
        state_.counters["p50_us"] = at(0.50);
        state_.counters["p95_us"] = at(0.95);
    }
    template <class Work>
    void time(const Work& work) {
        const auto start = Clock::now();
        work();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        state_.SetIterationTime(seconds);
        microseconds_.push_back(1e6 * seconds);
    }
    double at(double share) const {
        if (microseconds_.empty()) return 0.0;
        return microseconds_[static_cast<std::size_t>(share * static_cast<double>(microseconds_.size() - 1))];
    }

private:
    benchmark::State& state_;
    std::vector<double> microseconds_;
};

/// 1920 x 1080 with eight regions, each an ellipse, the topmost one (id 0) covering a good part.
Document eightRegions() {
    Scene scene;
    scene.picture = Box<Picture>(Picture({1920, 1080}, 3, std::vector<std::uint16_t>(1920 * 1080 * 3, 20000)));
    Document document = newDocument(std::move(scene));
    for (int i = 7; i >= 0; --i) {
        Region region;
        region.id = std::to_string(i);
        region.name = "Region " + region.id;
        region.mask = rasterised(Ellipse{{200.0 * i, 100.0}, {200.0 * i + 500.0, 900.0}}, {1920, 1080});
        document = *edited(std::move(document), AddRegion{std::move(region), 0});
    }
    return document;
}

/// Dabs along a path that wanders over the whole picture.
Dab dabOf(int i, double hardness) { return {{100.0 + (i * 37) % 1720, 100.0 + (i * 23) % 880}, {40.0, hardness, 1.0}}; }

/// A dab of radius 40 px through edited() and History::preview, as each frame of a stroke does it. `whole_us`: the
/// whole frame's mask written out as pixels once, which is what an editor without tiles does at the least.
void dab(benchmark::State& state) {
    const double hardness = static_cast<double>(state.range(0)) / 100.0;
    const Document document = eightRegions();
    History history(document);
    Percentiles percentiles(state);
    int i = 0;
    for (auto _ : state) {
        if (i % 40 == 0) {
            history.cancel();
            history.preview(document);
        }
        const Paint paint{"0", {dabOf(++i, hardness)}};
        percentiles.time([&] { history.preview(*edited(history.current(), paint)); });
    }
    constexpr int kWholeFrames = 20;
    const auto start = Clock::now();
    for (int k = 0; k < kWholeFrames; ++k)
        benchmark::DoNotOptimize(toImage(document.regions[0]->mask));
    const double whole = 1e6 * std::chrono::duration<double>(Clock::now() - start).count() / kWholeFrames;
    state.counters["whole_us"] = whole;
    state.counters["dabs_per_whole"] = whole / std::max(1e-3, percentiles.at(0.5));
}
BENCHMARK(dab)->Arg(100)->Arg(80)->Arg(0)->ArgName("hardness")->UseManualTime()->Unit(benchmark::kMicrosecond);

/// The same with "protect other regions".
void dabProtected(benchmark::State& state) {
    const Document document = eightRegions();
    History history(document);
    Percentiles percentiles(state);
    int i = 0;
    for (auto _ : state) {
        if (i % 40 == 0) history.preview(document);
        const Paint paint{"0", {dabOf(++i, 0.8)}, PaintMode::add, true};
        percentiles.time([&] { history.preview(*edited(history.current(), paint)); });
    }
}
BENCHMARK(dabProtected)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// The whole frame: the mask drawn anew from its outline and written out.
void wholeFrame(benchmark::State& state) {
    Percentiles percentiles(state);
    for (auto _ : state) {
        percentiles.time([&] {
            const Mask mask = rasterised(Ellipse{{0.0, 100.0}, {500.0, 900.0}}, {1920, 1080});
            benchmark::DoNotOptimize(toImage(mask));
        });
    }
}
BENCHMARK(wholeFrame)->UseManualTime()->Unit(benchmark::kMicrosecond);

void undoAndRedo(benchmark::State& state) {
    History history(eightRegions());
    for (int i = 0; i < 50; ++i) {
        history.preview(*edited(history.current(), Paint{"0", {dabOf(i, 0.8)}}));
        history.commit("Paint");
    }
    Percentiles percentiles(state);
    bool back = false;
    for (auto _ : state) {
        back = !back;
        percentiles.time([&] { back ? history.undo() : history.redo(); });
    }
}
BENCHMARK(undoAndRedo)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// A copy of the document, as it is handed to another thread.
void snapshot(benchmark::State& state) {
    const Document document = eightRegions();
    Percentiles percentiles(state);
    for (auto _ : state) {
        percentiles.time([&] { benchmark::DoNotOptimize(Document(document)); });
    }
}
BENCHMARK(snapshot)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// A stroke of 200 dabs committed as one edit.
void stroke(benchmark::State& state) {
    const Document document = eightRegions();
    Paint paint{"0", {}};
    for (int i = 0; i < 200; ++i)
        paint.dabs.push_back(dabOf(i, 0.8));
    Percentiles percentiles(state);
    for (auto _ : state) {
        percentiles.time([&] { benchmark::DoNotOptimize(edited(document, paint)); });
    }
}
BENCHMARK(stroke)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace ilf

BENCHMARK_MAIN();
