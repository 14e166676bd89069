// Shaped waves: what a wave costs to find (the lens's own time apart), and how far off the lens is while it holds.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "tests/devices/lens/shaped_figure.h"

namespace {

using namespace ilf;
using namespace ilf::devices;

constexpr std::uint64_t kVariations = 20;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// A recorder that knows how long it recorded: the simulated lens's time is not shaping's.
struct TimedRecorder {
    RecordLens record;
    double spent = 0.0;

    Result<LensRecord> operator()(const Harmonics& drive, Hertz rate) {
        const double start = now();
        auto got = record(drive, rate);
        spent += now() - start;
        return got;
    }
};

/// Times `work(recordLens)` without the lens.
template <class Work>
void timedWithoutLens(benchmark::State& state, Work work) {
    for (auto _ : state) {
        LensEmulator lens(lensParameters(LensPreset::datasheet));
        TimedRecorder timed{recorder(lens)};
        const double start = now();
        work(RecordLens(std::ref(timed)), lens.limits());
        state.SetIterationTime(now() - start - timed.spent);
    }
}

/// Three records and the fit; judged by what the wave designed on it does on the lens before anything is learnt.
void identify(benchmark::State& state) {
    const ShapedCase what;
    std::optional<LensResponse> response;
    timedWithoutLens(state, [&](const RecordLens& record, const DriveLimits& limits) {
        const auto found = identified(record, what.rate, 1.1, 2.2, what.harmonics, limits);
        if (found) response = *found;
    });
    const LensEmulator lens(lensParameters(LensPreset::datasheet));
    const auto made = response ? designed(*response, what.holds(), what.harmonics, lens.limits())
                               : Result<ShapedDesign>(fail(Fault::device, "not identified"));
    if (!made) return state.SkipWithError(made.error().what.c_str());
    state.counters["error"] = largestErrorIn(what.holds(), averageOf(sweepsOf(lens, made->drive, what.rate)));
    state.SetLabel("D in the holds before learning; datasheet");
}

void design(benchmark::State& state) {
    const ShapedCase what;
    LensEmulator lens(lensParameters(LensPreset::datasheet));
    const auto response = identified(recorder(lens), what.rate, 1.1, 2.2, what.harmonics, lens.limits());
    if (!response) return state.SkipWithError(response.error().what.c_str());
    double error = 0.0;
    for (auto _ : state) {
        const auto made = designed(*response, what.holds(), what.harmonics, lens.limits());
        error = made ? made->largestError_D : NAN;
        benchmark::DoNotOptimize(error);
    }
    state.counters["error"] = error;
    state.SetLabel("D predicted; datasheet; 30 % at 60 Hz");
}

void learn(benchmark::State& state) {
    const ShapedCase what;
    double error = 0.0;
    timedWithoutLens(state, [&](const RecordLens& record, const DriveLimits& limits) {
        const auto wave = learnt(record, what.rate, what.holds(), what.harmonics, limits);
        error = wave ? wave->largestError_D : NAN;
    });
    state.counters["error"] = error;
    state.SetLabel("D recorded; datasheet; 30 % at 60 Hz");
}

/// The worst of some lenses.
struct Worst {
    double averaged = 0.0, eachSweep = 0.0, peak_A = 0.0, rms_A = 0.0;
    int beyond = 0, refused = 0;
    std::vector<double> recorded;  ///< best so far, after the first play and each iteration

    void add(const ShapedFigure& figure, double allowed) {
        averaged = std::max(averaged, figure.averaged_D);
        eachSweep = std::max(eachSweep, figure.eachSweep_D);
        peak_A = std::max(peak_A, figure.peak_A);
        rms_A = std::max(rms_A, figure.rms_A);
        beyond += figure.averaged_D > allowed ? 1 : 0;
        recorded.resize(5);
        double best = figure.wave.errors_D[0];
        for (std::size_t i = 0; i < recorded.size(); ++i) {
            if (i < figure.wave.errors_D.size()) best = std::min(best, figure.wave.errors_D[i]);
            recorded[i] = std::max(recorded[i], best);
        }
    }
};

/// The figures: `error` is the worst of the nominal lens and its variations, in the average of nine sweeps; `one_sweep`
/// in the worst of them. play0..4: largest recorded error after the first play and each iteration, best so far.
void holds(benchmark::State& state, LensPreset preset, ShapedCase what) {
    for (auto _ : state) {
        Worst nominal, all;
        for (std::uint64_t seed = 0; seed <= kVariations; ++seed) {
            const auto figure = shapedFigure(preset, seed, what);
            if (!figure) {
                ++all.refused;
                continue;
            }
            if (seed == 0) nominal.add(*figure, allowed_D(preset));
            all.add(*figure, allowed_D(preset));
        }
        state.counters["error"] = all.averaged;
        state.counters["beyond"] = all.beyond + all.refused;
        state.counters["one_sweep"] = all.eachSweep;
        state.counters["peak_mA"] = 1e3 * all.peak_A;
        state.counters["rms_mA"] = 1e3 * all.rms_A;
        state.counters["nominal_one_sweep"] = nominal.eachSweep;
        state.counters["nominal_peak_mA"] = 1e3 * nominal.peak_A;
        state.counters["nominal_rms_mA"] = 1e3 * nominal.rms_A;
        for (std::size_t i = 0; i < all.recorded.size(); ++i) {
            state.counters["play" + std::to_string(i)] = all.recorded[i];
            state.counters["nominal_play" + std::to_string(i)] = nominal.recorded[i];
        }
        // What a sine holds within what is allowed: as sweeps are planned, and overshooting as far as it may.
        const double allowed = allowed_D(preset), planned = sineDuty(preset, 0, what, allowed, 0.0);
        char text[256];
        std::snprintf(text, sizeof text,
                      "D at worst (nominal %.3f); %.0f %% of the sweep; a sine within %.2f D: %.1f to %.1f %%",
                      nominal.averaged, 100.0 * what.duty, allowed, 100.0 * planned,
                      100.0 * std::max(planned, sineDuty(preset, 0, what, allowed, allowed)));
        state.SetLabel(text);
    }
}

BENCHMARK(identify)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(design)->Iterations(50)->Unit(benchmark::kMicrosecond);
BENCHMARK(learn)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int count, char** arguments) {
    benchmark::Initialize(&count, arguments);
    for (const LensPreset preset : kLensPresets) {
        const std::string name = "21 lenses " + std::string(word(preset));
        benchmark::RegisterBenchmark((name + " 60 Hz").c_str(), holds, preset, ShapedCase{60.0_Hz, 0.30})
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
        // Three harmonics where 450 Hz is next to half the DAC's rate.
        const int harmonics = preset == LensPreset::dirty ? 3 : 5;
        benchmark::RegisterBenchmark((name + " 90 Hz").c_str(), holds, preset, ShapedCase{90.0_Hz, 0.27, harmonics})
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    }
    // Sweeps of 16 values of its 1 kHz DAC each: none differs from the next.
    benchmark::RegisterBenchmark("21 lenses dirty 62.5 Hz", holds, LensPreset::dirty, ShapedCase{62.5_Hz, 0.30})
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
}
