// The perceived view: time beside error on every scene, rung and edit, beside what a library would do, on a machine
// whose peak is measured in the same run.
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "tests/bench/perceived/baseline_rows.h"
#include "tests/bench/perceived/calibration.h"
#include "tests/bench/perceived/engine_rows.h"
#include "tests/bench/perceived/plane_rows.h"
#include "tests/bench/perceived/report.h"
#include "tests/bench/perceived/scaling_rows.h"

namespace {

using namespace ilf;
using namespace ilf::bench;

struct Options {
    std::string csv, markdown;
    std::string only;  ///< sections: machine, plane, scene, baseline, scaling; or part of a scene's name
    double seconds = 0.2;
    bool errors = true;

    bool wants(const std::string& section) const {
        return only.empty() || only == section || (section != "plane" && section != "scaling" && !isSection());
    }
    bool wantsScene(const std::string& name) const {
        return only.empty() || isSection() || name.find(only) != std::string::npos;
    }

private:
    bool isSection() const {
        return only == "machine" || only == "plane" || only == "scene" || only == "baseline" || only == "scaling";
    }
};

constexpr const char* kUsage =
    "usage: bench_perceived [--csv FILE] [--markdown FILE] [--only SECTION|SCENE] [--seconds S]\n"
    "                       [--no-errors]\n"
    "sections: machine, plane, scene, baseline, scaling. --seconds: for one row (0.2).\n"
    "--benchmark_min_time=S, as the other benchmarks take it, is --seconds S --no-errors.\n";

bool parsed(int argc, char** argv, Options& options) {
    const std::string minTime = "--benchmark_min_time=";
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool more = i + 1 < argc;
        if (word == "--csv" && more) {
            options.csv = argv[++i];
        } else if (word == "--markdown" && more) {
            options.markdown = argv[++i];
        } else if (word == "--only" && more) {
            options.only = argv[++i];
        } else if (word == "--seconds" && more) {
            options.seconds = std::atof(argv[++i]);
        } else if (word == "--no-errors") {
            options.errors = false;
        } else if (word.starts_with(minTime)) {
            options.seconds = std::atof(word.c_str() + minTime.size());
            options.errors = false;
        } else {
            return false;
        }
    }
    return options.seconds > 0.0;
}

struct Wanted {
    Result<BenchScene> (*make)();
    bool baselines = false, sizesOnly = false;
};

/// "seam: 0.000 D in 1 of 16 slots, rms 0.012 D; ..."
void describe(const BenchScene& scene) {
    std::fprintf(stderr, "%s:", scene.name.c_str());
    for (const Level& level : scene.shown.plan.levels) {
        std::fprintf(stderr, " %.3f D in %zu of %zu slots, rms %.3f D;", level.power.si(), level.slots.size(),
                     scene.shown.plan.slots.size(), level.rmsError.si());
    }
    std::fputc('\n', stderr);
}

bool addScene(Table& table, const Wanted& wanted, const Options& options, const Machine& machine,
              const Patience& patience) {
    const auto scene = wanted.make();
    if (!scene) {
        std::fprintf(stderr, "%s\n", scene.error().what.c_str());
        return false;
    }
    if (!options.wantsScene(scene->name)) return true;
    describe(*scene);
    std::optional<Truth> truth;
    if (options.errors && !wanted.sizesOnly) {
        auto made = Truth::of(*scene);
        if (!made) {
            std::fprintf(stderr, "%s: %s\n", scene->name.c_str(), made.error().what.c_str());
            return false;
        }
        truth = *std::move(made);
    }
    const Truth* known = truth ? &*truth : nullptr;
    if (options.wants("scene")) addEngineRows(table, *scene, known, machine, patience, wanted.sizesOnly);
    if (options.wants("baseline") && wanted.baselines) addBaselineRows(table, *scene, known, 2);
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parsed(argc, argv, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const double load = loadAverage();
    Table table;
    const Machine machine = calibrated(table);
    const Patience patience{options.seconds, 30, 3, 300};
    bool good = true;
    if (options.wants("plane")) addPlaneRows(table, machine, patience);
    if (options.wants("scene") || options.wants("baseline")) {
        const std::vector<Wanted> scenes{
            {seamScene, true},
            {[] { return fourObjectsEye(); }, true},
            {[] { return fourObjectsCamera(); }, true},
            {[] { return fourObjectsEye(1024, bench::Light::usualBudget); }},
            {[] { return fourObjectsCamera(1024, bench::Light::usualBudget); }},
            {fourSlotsCamera},
            {litTwice},
            {slantedDesk},
            {[] { return manyRegions(8); }},
            {[] { return manyRegions(12); }},
            {nothingToBlur},
            {[] { return fourObjectsEye(512); }, false, true},
            {[] { return fourObjectsEye(2048); }, false, true},
            {[] { return fourObjectsCamera(512); }, false, true},
            {[] { return fourObjectsCamera(2048); }, false, true},
        };
        for (const Wanted& wanted : scenes)
            good = addScene(table, wanted, options, machine, patience) && good;
    }
    if (options.wants("scaling")) good = addScalingRows(table, patience) && good;

    if (!options.csv.empty() && !table.write(options.csv)) {
        std::fprintf(stderr, "%s cannot be written.\n", options.csv.c_str());
        return 1;
    }
    if (!options.markdown.empty()) {
        std::ofstream file(options.markdown);
        file << report(table, load);
        if (!file) {
            std::fprintf(stderr, "%s cannot be written.\n", options.markdown.c_str());
            return 1;
        }
    }
    return good ? 0 : 1;
}
