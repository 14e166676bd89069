#include "app/lens/lens_planner.h"

#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/plan/verdicts.h"
#include "projects/wave_database.h"

namespace ilf::app {

namespace {

/// These two ways choose among recorded waves, and the more there are the better.
bool takesRecords(const Rig& rig) { return rig.waves == WaveMode::paper || rig.waves == WaveMode::slotAware; }

}  // namespace

LensPlanner::Key LensPlanner::keyOf(const Rig& rig, Dioptre rest) {
    if (!rig.lens.empty()) {
        std::error_code none;  // a file that is not there is refused when it is read
        const auto written = std::filesystem::last_write_time(rig.lens, none).time_since_epoch().count();
        return {rig.lens, none ? 0.0 : static_cast<double>(written), false, 0.0};
    }
    return {std::string(), rig.sweepRate.si(), takesRecords(rig), std::round(rest.si())};
}

Result<Calibration> LensPlanner::calibration(const Rig& rig, Dioptre rest) {
    if (rig.waves == WaveMode::idealSine || (rig.lens.empty() && !lens_.preset)) return Calibration();
    Calibration& kept = known_[keyOf(rig, rest)];
    if (kept) return kept;
    auto made = !rig.lens.empty()   ? projects::openWaves(rig.lens).and_then(calibrationFrom)
                : takesRecords(rig) ? simulatedTable(*lens_.preset, rig.sweepRate)
                                    : simulatedCalibration(*lens_.preset, rig.sweepRate, rest);
    if (!made) return made;
    kept = *std::move(made);
    return kept;
}

Result<PlanInput> LensPlanner::input(const Document& document) {
    const Dioptre rest = document.wearer.camera ? 0.0_D : restPower(eyeOptics(document.wearer));
    return calibration(document.rig, rest).map([&](Calibration lens) {
        PlanInput input = planInput(document, std::move(lens));
        // The simulated ideal lens follows a sine exactly, whatever the rig would choose for another.
        if (!lens_.preset && document.rig.lens.empty()) input.rig.waves = WaveMode::idealSine;
        return input;
    });
}

Result<Plan> LensPlanner::plan(const PlanInput& input, const Plan* previous, bool learn) {
    std::vector<Dioptre> unlearnt;
    auto planned = ilf::plan(input, previous, &unlearnt);
    if (!learn || unlearnt.empty() || !this->learn(input, unlearnt)) return planned;
    PlanInput better = input;
    better.lens = known_[keyOf(input.rig, restOf(input))];
    planned = ilf::plan(better, planned ? &*planned : previous, &unlearnt);
    // Learnt and still not chosen: learning once more would not help.
    if (!unlearnt.empty()) cannotLearn_.insert({keyOf(input.rig, restOf(input)), unlearnt});
    return planned;
}

bool LensPlanner::learn(const PlanInput& input, const std::vector<Dioptre>& levels) {
    const Key key = keyOf(input.rig, restOf(input));
    if (!std::get<0>(key).empty() || !lens_.preset || cannotLearn_.contains({key, levels})) return false;
    auto learnt = withShapedWave(input.lens, *lens_.preset, levels, usualDuty(levels.size(), input.rig.sweepRate),
                                 kUsualHarmonics, input.rig.sweepRate);
    if (!learnt) {
        cannotLearn_.insert({key, levels});
        return false;
    }
    known_[key] = *std::move(learnt);
    return true;
}

double usualDuty(std::size_t levels, Hertz rate) {
    if (levels <= 2) return rate > 75.0_Hz ? 0.27 : 0.30;
    return 0.5 / static_cast<double>(levels);
}

}  // namespace ilf::app
