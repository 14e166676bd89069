#include "core/plan/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ilf {
namespace {

/// Mean of P and of (P - level)^2 over one slot, in closed form.
class SlotPower {
public:
    SlotPower(const Waveform& waveform, const Harmonics& square, Second start, Second duration)
        : mean_(waveform.power.meanOver(start * waveform.rate, duration * waveform.rate)),
          square_(square.meanOver(start * waveform.rate, duration * waveform.rate)) {}
    double mean() const { return mean_; }
    double squareError(double level) const { return std::max(0.0, square_ - 2.0 * level * mean_ + level * level); }

private:
    double mean_, square_;
};

double budget(const LevelWish& wish, Dioptre rest) {
    const double focus = kFocusErrorBudget.si();
    return wish.kind == LevelKind::focus ? focus : std::max(focus, kBlurErrorShare * abs(wish.power - rest).si());
}

std::size_t nearestLevel(const SlotPower& slot, const std::vector<LevelWish>& wishes) {
    std::size_t nearest = 0;
    for (std::size_t l = 1; l < wishes.size(); ++l) {
        if (slot.squareError(wishes[l].power.si()) < slot.squareError(wishes[nearest].power.si())) nearest = l;
    }
    return nearest;
}

/// Takes `candidates` in order of error while their rms stays in the budget.
Level filled(const LevelWish& wish, const Waveform& waveform, const std::vector<SlotPower>& powers,
             std::vector<int> candidates) {
    const auto error = [&](int slot) { return powers[static_cast<std::size_t>(slot)].squareError(wish.power.si()); };
    std::ranges::stable_sort(candidates, {}, error);
    const double allowed = std::pow(budget(wish, waveform.rest), 2);
    Level level{wish.kind, wish.power, {}, 1.0, {}};
    double sum = 0.0;
    for (const int slot : candidates) {
        const double count = static_cast<double>(level.slots.size());
        if (sum + error(slot) > allowed * (count + 1.0)) break;
        const double mean = powers[static_cast<std::size_t>(slot)].mean();
        const bool endOfSweep = level.slots.empty() && wish.power == waveform.high;
        if (wish.above && mean <= wish.above->si() && !endOfSweep) continue;
        sum += error(slot);
        level.slots.push_back(slot);
    }
    if (!level.slots.empty()) {
        level.rmsError = Dioptre::fromSi(std::sqrt(sum / static_cast<double>(level.slots.size())));
    }
    std::ranges::sort(level.slots);
    return level;
}

}  // namespace

Schedule scheduled(const Waveform& waveform, const Rig& rig, const std::vector<LevelWish>& wishes) {
    const int count = slotsPerSweep(rig);
    const Second duration = 1.0 / rig.slotRate;
    Schedule schedule{waveform, {}, {}, 1.0};
    const Harmonics square = squared(waveform.power);
    std::vector<SlotPower> powers;
    std::vector<std::vector<int>> candidates(wishes.size());
    for (int i = 0; i < count; ++i) {
        const Second start = static_cast<double>(i) * duration;
        powers.emplace_back(waveform, square, start, duration);
        schedule.slots.push_back({i, start, duration, std::nullopt, Dioptre::fromSi(powers.back().mean())});
        candidates[waveform.still() ? 0 : nearestLevel(powers.back(), wishes)].push_back(i);
    }
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (std::size_t l = 0; l < wishes.size(); ++l) {
        schedule.levels.push_back(filled(wishes[l], waveform, powers, candidates[l]));
        fewest = std::min(fewest, schedule.levels.back().slots.size());
    }
    for (std::size_t l = 0; l < wishes.size(); ++l) {
        Level& level = schedule.levels[l];
        if (level.slots.empty()) continue;
        level.weight = static_cast<double>(fewest) / static_cast<double>(level.slots.size());
        for (const int slot : level.slots)
            schedule.slots[static_cast<std::size_t>(slot)].level = static_cast<int>(l);
    }
    schedule.light = static_cast<double>(fewest) / static_cast<double>(count);
    return schedule;
}

}  // namespace ilf
