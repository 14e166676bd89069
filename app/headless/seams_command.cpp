#include "app/headless/seams_command.h"

#include <chrono>
#include <iostream>

#include "app/evaluate/seam_experiment.h"
#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/headless/seams_json.h"
#include "app/words.h"
#include "core/perceived/seam_errors.h"

namespace ilf::app {
namespace {

/// `text` is NAME=VALUE.
Result<void> setError(SeamErrors& errors, const std::string& text) {
    const auto help = "\"" + text + "\" is no error: write pupil=1, registration=0.25, gaze=5 or lens=2 (mm), " +
                      "nearer=5 or farther=10 (percent).";
    const auto equals = text.find('=');
    const auto value = equals == std::string::npos ? std::nullopt : wholeNumber(text.substr(equals + 1));
    if (!value || !(*value >= 0.0)) return fail(Fault::outOfRange, help);
    const std::string name = text.substr(0, equals);
    const Metre length = Metre::fromSi(1e-3 * *value);
    if (name == "pupil") {
        errors.pupil = length;
    } else if (name == "registration") {
        errors.registration = length;
    } else if (name == "gaze") {
        errors.gaze = length;
    } else if (name == "lens") {
        errors.lensToPupil = length;
    } else if (name == "nearer" && *value < 100.0) {
        errors.nearer = 0.01 * *value;
    } else if (name == "farther") {
        errors.farther = 0.01 * *value;
    } else {
        return fail(Fault::outOfRange, help);
    }
    return {};
}

std::optional<int> levelOf(const Plan& plan, const RegionId& id) {
    for (const RegionPlan& region : plan.regions) {
        if (region.id == id) return region.level;
    }
    return std::nullopt;
}

std::optional<double> earlier(const std::optional<double>& a, const std::optional<double>& b) {
    if (!a || !b) return a ? a : b;
    return std::min(*a, *b);
}

/// A neutral region is lit in every level, and displaced in the strongest one.
BorderMotion motionOf(const Compiled& compiled, const BorderSeam& seam, double speed_mm_s) {
    const Plan& plan = compiled.plan;
    const int displaced = levelOf(plan, seam.blurred).value_or(static_cast<int>(plan.levels.size()) - 1);
    const int other = levelOf(plan, seam.other).value_or(0);
    const EdgeLight light = edgeLight(plan, displaced, displaced == other ? 0 : other);
    MovingEdge edge{compiled.document.seam.feather, seam.hiding.blurRadius, 1e-3 * speed_mm_s, 0.0};
    using enum MaskTiming;
    using enum Watching;
    BorderMotion motion;
    motion.speed_mm_s = speed_mm_s;
    motion.heldPursued = movingSeam(light, edge, perPeriod, pursuit);
    motion.heldPassing = movingSeam(light, edge, perPeriod, still);
    motion.ownPursued = movingSeam(light, edge, perSlot, pursuit);
    motion.ownPassing = movingSeam(light, edge, perSlot, still);
    const auto shows = [&](MaskTiming timing) {
        auto speed = earlier(speedThatShows(light, edge, timing, pursuit), speedThatShows(light, edge, timing, still));
        if (speed) *speed *= 1e3;
        return speed;
    };
    motion.heldShows_mm_s = shows(perPeriod);
    motion.ownShows_mm_s = shows(perSlot);
    motion.feather_mm = featherForSpeed(edge.speed_m_s, light.period).in(1.0_mm);
    return motion;
}

int experimentCommand(const SeamsOptions& options) {
    const auto cases = seamExperiment(options.experiment);
    if (!cases) return refused("seams", cases.error());
    const auto written = writeSeamExperiment(options.out, *cases);
    if (!written) return refused("seams", written.error());
    std::cout << *written;
    return kDone;
}

}  // namespace

int seamsCommand(const SeamsOptions& options) {
    SeamQuestion question;
    const auto setErrors = [&]() -> Result<void> {
        for (const std::string& text : options.errors) {
            if (auto good = setError(question.errors, text); !good) return good;
        }
        return {};
    };
    if (const auto good = setErrors(); !good) {
        refused("seams", good.error());
        return kUsage;
    }
    if (options.file.empty() == options.experiment.empty() || options.experiment.empty() != options.out.empty()) {
        std::cerr << "illuminatedfocus seams: name a FILE, or --experiment FOLDER and -o FOLDER.\n";
        return kUsage;
    }
    if (!options.experiment.empty()) return experimentCommand(options);

    const auto project = prepared(options.file, options.rig);
    if (!project) return refused("seams", project.error());
    question.errors = knownErrors(project->compiled.document, project->compiled.plan);
    if (const auto good = setErrors(); !good) return refused("seams", good.error());
    const auto start = std::chrono::steady_clock::now();
    SeamsReport report{project->compiled, borderSeams(project->compiled, question), {}, 0.0};
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    report.took_ms = took.count();
    if (options.motion_mm_s) {
        for (const BorderSeam& seam : report.seams)
            report.motions.push_back(motionOf(project->compiled, seam, *options.motion_mm_s));
    }
    (options.json ? printSeamsJson : printSeams)(std::cout, report);
    return kDone;
}

}  // namespace ilf::app
