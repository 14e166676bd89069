#include "core/plan/sweep.h"

#include <algorithm>

namespace ilf {
namespace {

bool sameLight(const Rig& a, const Rig& b) {
    return a.sweepRate == b.sweepRate && a.slotRate == b.slotRate && a.bits == b.bits &&
           a.powerBudget == b.powerBudget && a.blurShare == b.blurShare && a.waves == b.waves &&
           a.lensMin == b.lensMin && a.lensMax == b.lensMax;
}

}  // namespace

SweepPlanner::SweepPlanner(const PlanInput& input, Dioptre rest, const Plan* previous) : input_(input), rest_(rest) {
    if (previous == nullptr) return;
    work_ = previous->work;
    if (!previous->parts || previous->input.lens != input.lens || !sameLight(previous->input.rig, input.rig)) return;
    before_ = *previous->parts;
    parts_ = {before_.wish, before_.choice, before_.unshaped, {}};
    known_ = true;
}

WaveChoice SweepPlanner::chosen(const WaveWish& wish) {
    parts_.unshaped.clear();
    if (wish.low == wish.high) return {stillWave(wish.rest, wish.low, wish.rate), {}, wish.high};
    if (!input_.lens || input_.rig.waves == WaveMode::idealSine) {
        return {idealSine(wish.rest, wish.low, wish.high, wish.rate, wish.lowAt / wish.rate), {}, input_.rig.lensMax};
    }
    WaveChoice choice = chosenWave(*input_.lens, input_.rig.waves, wish);
    if (choice.wave || input_.rig.waves != WaveMode::shaped) return choice;
    parts_.unshaped = choice.why;
    return chosenWave(*input_.lens, WaveMode::continuous, wish);
}

const WaveChoice& SweepPlanner::wave(Dioptre low, Dioptre high, std::vector<Dioptre> levels) {
    const double slot = 1.0 / slotsPerSweep(input_.rig);
    const WaveWish wish{rest_, low, high, input_.rig.sweepRate, std::move(levels), slot, 0.5 * slot};
    if (known_ && parts_.wish == wish) {
        ++work_.wavesKept;
        return parts_.choice;
    }
    ++work_.wavesChosen;
    parts_.wish = wish;
    parts_.choice = chosen(wish);
    parts_.schedules.clear();
    before_.schedules.clear();
    known_ = true;
    return parts_.choice;
}

const Schedule& SweepPlanner::schedule(const std::vector<LevelWish>& wishes) {
    const auto asked = [&](const auto& known) { return known.first == wishes; };
    if (const auto made = std::ranges::find_if(parts_.schedules, asked); made != parts_.schedules.end()) {
        return made->second;
    }
    const auto kept = std::ranges::find_if(before_.schedules, asked);
    if (kept != before_.schedules.end()) {
        ++work_.schedulesKept;
        parts_.schedules.push_back(*kept);
    } else {
        ++work_.schedulesMade;
        parts_.schedules.emplace_back(wishes, scheduled(*parts_.choice.wave, input_.rig, wishes));
    }
    return parts_.schedules.back().second;
}

}  // namespace ilf
