// Choosing a wave: what it costs, and how far the slots lit with it are from what was asked, on every lens preset.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "app/lens/record_lens.h"
#include "core/base/parallel.h"
#include "core/lens/calibration.h"
#include "devices/simulated/lens_emulator.h"

namespace {

using namespace ilf;
using app::LensBench;
using devices::kLensPresets;
using devices::LensPreset;

constexpr Hertz kRate = 60.0_Hz;
constexpr int kSlots = 16;
constexpr std::uint64_t kVariations = 20;

/// The paper's range: from 0 D to 0.7 ... 5.2 D.
std::vector<WaveWish> wishes(double step_D) {
    std::vector<WaveWish> out;
    for (int i = 0; 0.7 + step_D * i < 5.21; ++i) {
        WaveWish wish;
        wish.high = Dioptre::fromSi(0.7 + step_D * i);
        wish.levels = {wish.low, wish.high};
        out.push_back(wish);
    }
    return out;
}

/// Rms errors in dioptres of the two slots a plan lights, played without noise: for each level the slot of the grid
/// that errs least, wherever in the sweep it lies.
struct SlotErrors {
    double focus = 0.0, blur = 0.0;
};
SlotErrors played(devices::LensEmulator lens, const Waveform& wave, const WaveWish& wish) {
    constexpr int kSamples = 40, kSweeps = 3;  // in a slot; a DAC at 1 kHz repeats after three sweeps
    lens.play(wave.drive, kRate);
    lens.warmUp();
    lens.advance(Second::fromSi(12.0 / kRate.si()));
    std::array<double, kSlots> low{}, high{};
    for (int i = 0; i < kSweeps * kSlots * kSamples; ++i) {
        const auto slot = static_cast<std::size_t>(i / kSamples % kSlots);
        const double power = lens.power().si();
        low[slot] += (power - wish.low.si()) * (power - wish.low.si()) / (kSamples * kSweeps);
        high[slot] += (power - wish.high.si()) * (power - wish.high.si()) / (kSamples * kSweeps);
        lens.advance(Second::fromSi(1.0 / (kRate.si() * kSlots * kSamples)));
    }
    return {std::sqrt(*std::ranges::min_element(low)), std::sqrt(*std::ranges::min_element(high))};
}

struct Errors {
    double focus = 0.0, blur = 0.0, worst = 0.0;  ///< rms over the targets, and the largest of all
    int missing = 0;
    void include(const Errors& other) {
        focus = std::max(focus, other.focus);
        blur = std::max(blur, other.blur);
        worst = std::max(worst, other.worst);
        missing += other.missing;
    }
};
Errors errorsOf(const LensBench& bench, const LensCalibration& lens, WaveMode mode, double step_D) {
    const std::vector<WaveWish> asked = wishes(step_D);
    std::vector<SlotErrors> errors(asked.size());
    std::vector<char> missing(asked.size());
    parallelFor(static_cast<int>(asked.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const WaveChoice choice = chosenWave(lens, mode, asked[at]);
        if (choice.wave)
            errors[at] = played(bench.lens(), *choice.wave, asked[at]);
        else
            missing[at] = 1;
    });
    Errors out;
    double focus = 0.0, blur = 0.0;
    for (const SlotErrors& one : errors) {
        focus += one.focus * one.focus;
        blur += one.blur * one.blur;
        out.worst = std::max({out.worst, one.focus, one.blur});
    }
    out.missing = static_cast<int>(std::ranges::count(missing, 1));
    const double served = std::max(1.0, static_cast<double>(asked.size()) - out.missing);
    out.focus = std::sqrt(focus / served);
    out.blur = std::sqrt(blur / served);
    return out;
}

LensBench benchOf(LensPreset preset, std::uint64_t seed) {
    LensBench bench;
    bench.preset = preset;
    bench.seed = seed;
    bench.options.settle = 0.12_s;
    bench.options.periods = 4;
    return bench;
}

template <class T>
T orStop(Result<T> made) {
    if (made) return *std::move(made);
    std::fprintf(stderr, "%s\n", made.error().what.c_str());
    std::exit(1);
}

LensCalibration calibrated(const LensBench& bench, std::vector<LensRecord>& records) {
    LensCalibration lens;
    lens.limits = bench.lens().limits();
    records = orStop(app::surveyed(bench, kRate, 40));
    lens.models.push_back(orStop(fitted(records)));
    return lens;
}

/// One preset: its 2485 waves and its model, and what comes of them.
struct Lens {
    LensCalibration calibration;
    std::vector<LensRecord> survey;
    std::array<Errors, 5> errors;  ///< by mode
    Errors varied;                 ///< continuous, the worst of the variations

    explicit Lens(LensPreset preset) {
        const LensBench bench = benchOf(preset, 0);
        calibration = calibrated(bench, survey);
        calibration.tables.push_back(orStop(waveTable(orStop(app::paperWaves(bench, kRate)))));
        for (const WaveMode mode : {WaveMode::paper, WaveMode::slotAware, WaveMode::continuous})
            errors[static_cast<std::size_t>(mode)] = errorsOf(bench, calibration, mode, 0.1);
        for (std::uint64_t seed = 1; seed <= kVariations; ++seed) {
            std::vector<LensRecord> records;
            const LensBench other = benchOf(preset, seed);
            varied.include(errorsOf(other, calibrated(other, records), WaveMode::continuous, 0.3));
        }
    }
};

const Lens& lens(LensPreset preset) {
    static const std::vector<Lens> made = [] {
        std::vector<Lens> all;
        for (const LensPreset one : kLensPresets)
            all.emplace_back(one);
        return all;
    }();
    return made[static_cast<std::size_t>(preset)];
}

/// This thread's own seconds: what others do on the same cores is not counted.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Times `ask(wish)`; the time shown is that of one.
template <class Ask>
void timed(benchmark::State& state, Ask&& ask) {
    const std::vector<WaveWish> asked = wishes(0.1);
    for (auto _ : state) {
        const double start = processorTime();
        for (const WaveWish& wish : asked)
            benchmark::DoNotOptimize(ask(wish));
        state.SetIterationTime((processorTime() - start) / static_cast<double>(asked.size()));
    }
}

std::string text(const char* format, double a, double b, double c) {
    char out[160];
    std::snprintf(out, sizeof out, format, a, b, c);
    return out;
}

void showErrors(benchmark::State& state, LensPreset preset, WaveMode mode) {
    const Errors& errors = lens(preset).errors[static_cast<std::size_t>(mode)];
    state.counters["error"] = std::max(errors.focus, errors.blur);
    std::string label = text("D slot rms (focus %.3f; blur %.3f); worst %.3f", errors.focus, errors.blur, errors.worst);
    if (errors.missing > 0) label += "; " + std::to_string(errors.missing) + " of 46 not covered";
    if (mode == WaveMode::continuous) {
        const Errors& varied = lens(preset).varied;
        label += text("; 20 variations (%.3f; %.3f); worst %.3f", varied.focus, varied.blur, varied.worst);
        if (varied.missing > 0) label += "; " + std::to_string(varied.missing) + " not covered";
    }
    state.SetLabel(label);
}

constexpr LensPreset kUsual = LensPreset::datasheet;

void paperQuery(benchmark::State& state) {
    const WaveTable& table = lens(kUsual).calibration.tables[0];
    timed(state,
          [&](const WaveWish& wish) { return narrowestCovering(table, 0.0, wish.high.si(), 0.0, wish.slotLength); });
    state.SetLabel("exact; " + std::to_string(table.waves.size()) + " waves");
}

void slotAwareQuery(benchmark::State& state) {
    const WaveTable& table = lens(kUsual).calibration.tables[0];
    timed(state,
          [&](const WaveWish& wish) { return leastSlotError(table, 0.0, wish.high.si(), 0.0, wish.slotLength); });
    state.SetLabel("exact; " + std::to_string(table.waves.size()) + " waves");
}

void continuousFit(benchmark::State& state) {
    const Lens& one = lens(kUsual);
    for (auto _ : state) {
        const double start = processorTime();
        benchmark::DoNotOptimize(fitted(one.survey));
        state.SetIterationTime(processorTime() - start);
    }
    const ContinuousModel& model = one.calibration.models[0];
    state.counters["error"] = model.rmsFit_D;
    state.SetLabel(text("D rms against %.0f records whose noise is %.3f; degree %.0f",
                        static_cast<double>(one.survey.size()), one.survey[0].noise_D, model.degree));
}

void continuousInversion(benchmark::State& state) {
    const ContinuousModel& model = lens(kUsual).calibration.models[0];
    timed(state, [&](const WaveWish& wish) { return inverted(model, 0.0, wish.high.si(), 0.0); });
    double worst = 0.0;
    for (const WaveWish& wish : wishes(0.1)) {
        const auto found = inverted(model, 0.0, wish.high.si(), 0.0);
        if (!found) return state.SkipWithError("no drive");
        const Extremes e = extremes(found->power);
        worst = std::max({worst, std::abs(e.low), std::abs(e.high - wish.high.si())});
    }
    state.counters["error"] = worst;
    state.SetLabel("D between predicted and wished extremes");
}

void chosen(benchmark::State& state, WaveMode mode, LensPreset preset) {
    const LensCalibration& calibration = lens(preset).calibration;
    timed(state, [&](const WaveWish& wish) { return chosenWave(calibration, mode, wish); });
    showErrors(state, preset, mode);
}

BENCHMARK(paperQuery)->UseManualTime()->Iterations(200);
BENCHMARK(slotAwareQuery)->UseManualTime()->Iterations(200);
BENCHMARK(continuousFit)->UseManualTime()->Iterations(20)->Unit(benchmark::kMillisecond);
BENCHMARK(continuousInversion)->UseManualTime()->Iterations(100);

}  // namespace

int main(int argc, char** argv) {
    for (const WaveMode mode : {WaveMode::paper, WaveMode::slotAware, WaveMode::continuous}) {
        for (const LensPreset preset : kLensPresets) {
            const std::string name = "chosenWave/" + std::string(word(mode)) + "/" + std::string(word(preset));
            benchmark::RegisterBenchmark(name.c_str(), chosen, mode, preset)->UseManualTime()->Iterations(20);
        }
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
