// Planning eight regions: from nothing, after edits that change little, and what the edit did not change; beside each
// time the largest rms power error of the plan's slots on the lens itself.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "app/lens/lens_planner.h"
#include "core/plan/report.h"

namespace {

using namespace ilf;

PlanInput eightRegions(app::LensPlanner& planner, WaveMode waves) {
    Document document;
    document.rig.waves = waves;
    PlanInput input;
    input.eye = eyeOptics(document.wearer);
    input.rig = document.rig;
    for (int i = 0; i < 8; ++i) {
        const Metre at = (0.4 + 0.15 * i) * 1.0_m;
        const std::string name(1, static_cast<char>('A' + i));
        input.objects.push_back({name, name, i % 2 == 0 ? Look::blur : Look::focus, std::nullopt, at, at});
    }
    input.lens = *planner.calibration(document.rig);
    return input;
}

/// What the emulator does with the plan's drive in the slots that are lit, against their levels.
double errorOnLens(const Plan& plan) {
    devices::LensEmulator lens;
    devices::RecordOptions quiet;
    quiet.noise_D = 0.0;
    quiet.samples = 1600;
    const auto record = devices::recorded(lens, plan.waveform.drive, plan.waveform.rate, quiet);
    if (!record) return std::nan("");
    double worst = 0.0;
    for (const Level& level : plan.levels) {
        double sum = 0.0, light = 0.0;
        for (const Slot& slot : plan.slots) {
            for (const LevelLight& lit : slot.lit) {
                if (&plan.levels[static_cast<std::size_t>(lit.level)] != &level) continue;
                const auto n = record->power_D.size(), each = n / plan.slots.size();
                const std::size_t from = static_cast<std::size_t>(slot.index) * each;
                for (std::size_t i = from; i < from + each; ++i)
                    sum += lit.weight * std::pow(record->power_D[i] - level.power.si(), 2) / static_cast<double>(each);
                light += lit.weight;
            }
        }
        if (light > 0.0) worst = std::max(worst, std::sqrt(sum / light));
    }
    return worst;
}

void describe(benchmark::State& state, const Plan& plan) {
    char text[96];
    std::snprintf(text, sizeof text, "%.3f D rms on the lens; %.1f %% light", errorOnLens(plan), 100.0 * plan.light);
    state.SetLabel(text);
}

app::LensPlanner& planner() {
    static app::LensPlanner one{devices::SimulatedLens(devices::LensPreset::datasheet)};
    return one;
}

void fromNothing(benchmark::State& state, WaveMode waves) {
    PlanInput input = eightRegions(planner(), waves);
    Plan planned = *planner().plan(input, nullptr, true);  // a shaped wave is learnt here, not in the loop
    input = planned.input;
    for (auto _ : state)
        benchmark::DoNotOptimize(planned = *plan(input));
    describe(state, planned);
}
BENCHMARK_CAPTURE(fromNothing, continuous, WaveMode::continuous)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fromNothing, shaped, WaveMode::shaped)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fromNothing, paper, WaveMode::paper)->Unit(benchmark::kMicrosecond);

/// Region B, in focus, moves: neither wave nor slots can change.
void afterSmallEdit(benchmark::State& state) {
    PlanInput input = eightRegions(planner(), WaveMode::continuous);
    Plan last = *plan(input);
    const std::uint64_t chosen = last.work.wavesChosen, made = last.work.schedulesMade;
    int i = 0;
    for (auto _ : state) {
        input.objects[1].nearest = input.objects[1].farthest = (0.55 + 0.0001 * (++i % 100)) * 1.0_m;
        Plan next = *plan(input, &last);
        benchmark::DoNotOptimize(last = std::move(next));
    }
    char text[96];
    std::snprintf(text, sizeof text, "%d plans; %d waves chosen; %d schedules made",
                  static_cast<int>(last.work.plans - 1), static_cast<int>(last.work.wavesChosen - chosen),
                  static_cast<int>(last.work.schedulesMade - made));
    state.SetLabel(text);
}
BENCHMARK(afterSmallEdit)->Unit(benchmark::kMicrosecond);

void report(benchmark::State& state) {
    const Plan planned = *plan(eightRegions(planner(), WaveMode::continuous));
    for (auto _ : state)
        benchmark::DoNotOptimize(planReport(planned));
}
BENCHMARK(report)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
