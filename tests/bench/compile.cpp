// How long compiling takes: from nothing, and after one dab, and how even the light is that comes out.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "core/document/edit.h"
#include "core/document/stroke.h"
#include "tests/core/compile/received.h"

namespace {

using namespace ilf;

/// Eight regions of 8 looks and sizes on one desk at half a metre, four of them blurred with R near 7 px on the raster
/// and a feather of 10 mm (17 px).
Document eightRegions(Size picture, Size projector) {
    Document document = flatDocument(picture, Look::focus, 0.5_m);
    document.rig.projector = projector;
    document.wearer.pupil = 6.3_mm;
    for (int i = 0; i < 8; ++i) {
        const double w = picture.width, h = picture.height, x = w * (0.02 + 0.245 * (i % 4)),
                     y = h * (0.06 + 0.48 * (i / 4));
        const Point<CameraFrame> a{x, y}, b{x + 0.2 * w, y + 0.38 * h};
        const Mask mask = i % 3 == 0 ? rasterised(Rectangle{a, b}, picture) : rasterised(Ellipse{a, b}, picture);
        const Look look = i % 2 == 0 ? Look::blur : i % 4 == 1 ? Look::focus : Look::neutral;
        document.regions.push_back(regionOf("region " + std::to_string(i), look, 0.5_m, mask));
    }
    return document;
}

double blurRadiusOnRaster(const Compiled& compiled) {
    const Document& d = compiled.document;
    return blurRadiusOnSurface(eyeOptics(d.wearer), 0.5_m, compiled.plan.focusPower, compiled.plan.levels.back().power)
               .si() *
           pixelsPerMetre(d, 0.5_m) * pixelMap(d).nearest().m[0];
}

/// Times of single runs in microseconds.
class Times {
public:
    template <class Work>
    void time(Work&& work) {
        const auto start = std::chrono::steady_clock::now();
        work();
        us_.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    double quantile(double q) {
        std::ranges::sort(us_);
        return us_.empty() ? 0.0 : us_[static_cast<std::size_t>(q * static_cast<double>(us_.size() - 1))];
    }

private:
    std::vector<double> us_;
};

void compileFromNothing(benchmark::State& state) {
    const Document document = eightRegions({1024, 768}, {1024, 768});
    const Plan wanted = planned(document);
    Times times;
    for (auto _ : state)
        times.time([&] { benchmark::DoNotOptimize(compile(document, wanted)); });
    const Compiled compiled = compile(document, wanted).value();
    state.counters["p50_us"] = times.quantile(0.5);
    state.counters["p95_us"] = times.quantile(0.95);
    state.counters["R_px"] = blurRadiusOnRaster(compiled);
    state.counters["seam_tiles"] = compiled.counters.seamTiles;
    state.counters["error"] = receivedOver(compiled, 0.5_m, {10, 30, 520, 400}, 11).worst();
    state.SetLabel("of the light, max |I - 1|");
}
BENCHMARK(compileFromNothing)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

/// A dab of radius 40 px on a 1920 x 1080 picture, at the border of a blurred region, and what the whole frame costs.
void compileAfterDab(benchmark::State& state) {
    Document document = eightRegions({1920, 1080}, {1024, 768});
    const Plan wanted = planned(document);
    const Compiled before = compile(document, wanted).value();
    Times whole;
    for (int i = 0; i < 20; ++i)
        whole.time([&] { benchmark::DoNotOptimize(compile(document, wanted)); });
    std::vector<Document> dabbed;
    for (int i = 0; i < 16; ++i) {
        const Dab dab{{430.0 + i, 240.0 + 7 * i}, {40.0, 0.8, 1.0}};
        dabbed.push_back(edited(document, Paint{"region 0", {dab}, PaintMode::add, false}).value());
    }
    Times times;
    std::size_t next = 0;
    for (auto _ : state) {
        const Document& now = dabbed[next++ % dabbed.size()];
        times.time([&] { benchmark::DoNotOptimize(compile(now, wanted, &before)); });
    }
    const Compiled after = compile(dabbed[0], wanted, &before).value();
    state.counters["p50_us"] = times.quantile(0.5);
    state.counters["p95_us"] = times.quantile(0.95);
    state.counters["whole_us"] = whole.quantile(0.5);
    state.counters["ratio"] = whole.quantile(0.5) / times.quantile(0.5);
    state.counters["tiles_computed"] = after.counters.computed;
    state.counters["tiles_shared"] = after.counters.unchanged;
    state.counters["R_px"] = blurRadiusOnRaster(after);
    state.counters["error"] = receivedOver(after, 0.5_m, {180, 130, 290, 340}, 7).worst();
    state.SetLabel("of the light, max |I - 1|");
}
BENCHMARK(compileAfterDab)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
