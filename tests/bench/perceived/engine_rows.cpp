#include "tests/bench/perceived/engine_rows.h"

#include <algorithm>

#include "core/perceived/view_engine.h"
#include "tests/bench/perceived/optics_of.h"

namespace ilf::bench {
namespace {

/// Edits in a row before the first state is shown again, untimed.
constexpr int kSteps = 6;

Steps dabs(const BenchScene& scene, int diameter, bool mask) {
    Steps steps{edit::dab(diameter, mask), {scene.shown}};
    for (int step = 0; step < kSteps; ++step) {
        const Shown& from = steps.shown.back();
        if (!mask) {
            steps.shown.push_back(dabbedLight(scene, from, diameter, step));
        } else if (auto next = dabbedMask(scene, from, diameter, step)) {
            steps.shown.push_back(*std::move(next));
        } else {
            return {steps.what, {}};
        }
    }
    return steps;
}

double median(std::vector<double> values) {
    if (values.empty()) return kNothing;
    std::ranges::sort(values);
    return values[values.size() / 2];
}

}  // namespace

std::string edit::dab(int diameter, bool mask) {
    return "dab " + std::to_string(diameter) + (mask ? " mask" : " light");
}

std::vector<Steps> stepsOf(const BenchScene& scene) {
    const Shown& shown = scene.shown;
    std::vector<Steps> all{
        {edit::kFirst, {shown}}, {edit::kFull, {shown, dimmed(shown), shown}}, {edit::kNothing, {shown, shown}}};
    for (const int diameter : {32, 128}) {
        all.push_back(dabs(scene, diameter, false));
        if (!scene.byHand && !scene.painted.empty()) all.push_back(dabs(scene, diameter, true));
    }
    if (!scene.moved.empty()) {
        Steps steps{edit::kGeometry, {shown}};
        for (int step = 1; step <= kSteps; ++step) {
            auto next = moved(scene, step);
            if (!next) break;
            steps.shown.push_back(*std::move(next));
        }
        if (steps.shown.size() > 1) all.push_back(std::move(steps));
    }
    std::erase_if(all, [](const Steps& steps) { return steps.shown.empty(); });
    return all;
}

Row engineRow(const BenchScene& scene, const Steps& steps, Rung rung, int threads, const Patience& patience) {
    Row row{.section = "scene", .scene = scene.name, .method = std::string(word(rung)), .what = steps.what};
    row.threads = threads;
    ViewRequest request = scene.request;
    request.rung = rung;
    ViewEngine engine(threads);
    std::vector<double> geometry;
    const auto see = [&](const Shown& shown) {
        const auto view = engine.see(shown.document, shown.plan, shown.program, request);
        if (!view) row.note = view.error().what;
        return view;
    };
    const auto count = static_cast<int>(steps.shown.size()) - 1;
    const bool fresh = count == 0;
    row.times = timed(
        patience,
        [&](int i) {
            const auto view = see(steps.shown[static_cast<std::size_t>(fresh ? 0 : 1 + i % count)]);
            if (!view) return;
            geometry.push_back(view->counters.geometry_ms);
            row.tiles = view->counters.tiles;
            row.computed = std::max(row.computed, view->counters.computed);
        },
        [&](int i) {
            if (fresh) {
                engine = ViewEngine(threads);
            } else if (i % count == 0) {
                see(steps.shown[0]);
            }
        });
    row.geometry = median(geometry);
    return row;
}

void addEngineRows(Table& table, const BenchScene& scene, const Truth* truth, const Machine& machine,
                   const Patience& patience, bool sizesOnly) {
    std::vector<Steps> all = stepsOf(scene);
    if (sizesOnly)
        std::erase_if(all, [](const Steps& steps) { return steps.what != edit::kFull && steps.what != edit::kFirst; });
    const double sums = perimeterSums(scene), bytes = leastBytes(scene);
    for (const Rung rung : kRungs) {
        Errors errors;
        if (truth) {
            ViewRequest request = scene.request;
            request.rung = rung;
            const auto view = ViewEngine(2).see(scene.shown.document, scene.shown.plan, scene.shown.program, request);
            if (view) errors = truth->against(view->radiance());
        }
        for (const int threads : {1, 2}) {
            for (const Steps& steps : all) {
                Row row = engineRow(scene, steps, rung, threads, patience);
                if (steps.what == edit::kFull) {
                    row.errors = errors;
                    row.ofFma = 2.0 * sums / (threads * machine.gflops * 1e6) / row.times.p50;
                    row.ofMemory = bytes / (machine.bandwidth(threads) * 1e6) / row.times.p50;
                }
                table.add(std::move(row));
            }
        }
    }
}

}  // namespace ilf::bench
