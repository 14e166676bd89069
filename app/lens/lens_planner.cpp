#include "app/lens/lens_planner.h"

#include "projects/wave_database.h"

namespace ilf::app {

namespace {

/// These two ways choose among recorded waves, and the more there are the better.
bool takesRecords(const Rig& rig) { return rig.waves == WaveMode::paper || rig.waves == WaveMode::slotAware; }

}  // namespace

LensPlanner::Key LensPlanner::keyOf(const Rig& rig) {
    if (!rig.lens.empty()) return {rig.lens, 0.0, false};
    return {std::string(), rig.sweepRate.si(), takesRecords(rig)};
}

Result<Calibration> LensPlanner::calibration(const Rig& rig) {
    if (rig.waves == WaveMode::idealSine || (rig.lens.empty() && !lens_.preset)) return Calibration();
    Calibration& kept = known_[keyOf(rig)];
    if (kept) return kept;
    auto made = !rig.lens.empty()   ? projects::openWaves(rig.lens).and_then(calibrationFrom)
                : takesRecords(rig) ? simulatedTable(*lens_.preset, rig.sweepRate)
                                    : simulatedCalibration(*lens_.preset, rig.sweepRate);
    if (!made) return made;
    kept = *std::move(made);
    return kept;
}

Result<PlanInput> LensPlanner::input(const Document& document) {
    return calibration(document.rig).map([&](Calibration lens) { return planInput(document, std::move(lens)); });
}

Result<Plan> LensPlanner::plan(const PlanInput& input, const Plan* previous, bool learn) {
    auto planned = ilf::plan(input, previous);
    if (!planned || !learn || planned->unlearnt.empty() || !this->learn(input, planned->unlearnt)) return planned;
    PlanInput better = input;
    better.lens = known_[keyOf(input.rig)];
    return ilf::plan(better, &*planned);
}

bool LensPlanner::learn(const PlanInput& input, const std::vector<Dioptre>& levels) {
    const Key key = keyOf(input.rig);
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
