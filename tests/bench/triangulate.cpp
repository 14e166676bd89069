// How long triangulation takes for a scan of 1280 x 1024 pixels, and how wrong its depth is.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

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

BENCHMARK(depthFromScan)->ArgName("whole")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
