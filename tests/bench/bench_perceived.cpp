// The perceived view of four objects at full size, beside the still program that skips all of it.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/perceived/perceived.h"
#include "tests/core/perceived/small_scene.h"

using namespace ilf;
using namespace ilf::test;

namespace {

constexpr Size kFull{1024, 768};

Mask disc(double x, double y, double radius) {
    return maskOf(kFull, [=](int i, int j) { return std::hypot(i + 0.5 - x, j + 0.5 - y) < radius; });
}

/// The paper's distances: A 0.25 m, C 0.5 m, D 1.3 m blurred, B 0.5 m focused, before a neutral wall.
Played fourObjects(Look blurred) {
    Document d =
        document({region("A", blurred, 0.25, disc(250, 500, 150)), region("B", Look::focus, 0.5, disc(520, 400, 140)),
                  region("C", blurred, 0.5, disc(760, 500, 130)), region("D", blurred, 1.3, disc(600, 200, 120))},
                 Look::neutral, 2.0, kFull);
    d.scene.scale.focalPixels = focalPixels(kFull.width, 60.0);
    return played(d);
}

void view(benchmark::State& state, const Played& scene, double scale) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(perceived(scene.document, scene.plan, scene.program, {Eye::left, {}, scale}));
    }
}

void BM_fourObjects(benchmark::State& state) { view(state, fourObjects(Look::blur), 1.0); }
void BM_fourObjectsHalfSize(benchmark::State& state) { view(state, fourObjects(Look::blur), 0.5); }
void BM_nothingToBlur(benchmark::State& state) { view(state, fourObjects(Look::focus), 1.0); }
void BM_layers(benchmark::State& state) {
    const Played scene = fourObjects(Look::blur);
    for (auto _ : state)
        benchmark::DoNotOptimize(layers(scene.document, scene.plan, 1.0));
}

}  // namespace

BENCHMARK(BM_fourObjects)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_fourObjectsHalfSize)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_nothingToBlur)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_layers)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
