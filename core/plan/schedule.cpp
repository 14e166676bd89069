#include "core/plan/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ilf {
namespace {

/// Mean of P and of P^2 in each slot, in closed form.
class SlotPowers {
public:
    SlotPowers(const Waveform& wave, double delay, int count) {
        const double length = 1.0 / count;
        const Harmonics mean = averaged(wave.power, length), square = averaged(squared(wave.power), length);
        for (int i = 0; i < count; ++i) {
            const double centre = (i + 0.5) * length - delay;
            mean_.push_back(mean.at(centre));
            square_.push_back(square.at(centre));
        }
    }
    double mean(int slot) const { return mean_[static_cast<std::size_t>(slot)]; }
    /// Mean of (P - level)^2.
    double squareError(int slot, double level) const {
        const auto i = static_cast<std::size_t>(slot);
        return std::max(0.0, square_[i] - 2.0 * level * mean_[i] + level * level);
    }

private:
    std::vector<double> mean_, square_;
};

/// The most light one level can have.
struct Served {
    std::vector<int> order;  ///< its slots, best first
    double exposure = 0.0;   ///< all of them whole but perhaps the last
};

constexpr double kWorstRecorded_D = 0.5;

class Scheduler {
public:
    Scheduler(const Waveform& wave, double delay, const Rig& rig, const std::vector<LevelWish>& wishes)
        : wave_(wave), rig_(rig), wishes_(wishes), count_(slotsPerSweep(rig)), powers_(wave, delay, count_) {
        exposure_ = std::numeric_limits<double>::infinity();
        for (std::size_t l = 0; l < wishes.size(); ++l) {
            served_.push_back(served(l));
            exposure_ = std::min(exposure_, served_.back().exposure);
        }
        // A slot's picture has steps of its own, and less than one step is no light.
        const double steps = std::exp2(rig.bits) - 1.0;
        const double whole = std::floor(exposure_ + 1e-12);
        exposure_ = whole + std::floor((exposure_ - whole) * steps + 1e-9) / steps;
    }

    /// Slots' worth of light of every level; 0 if one has none.
    double exposure() const { return exposure_; }
    /// Sum of all levels' mean square errors: the lower, the better the wave lies on the slots.
    double squareErrors() const {
        double sum = 0.0;
        for (std::size_t l = 0; l < served_.size(); ++l)
            sum += squareErrorOf(l, exposure_);
        return sum;
    }

    void fill(Schedule& schedule) const {
        const Second duration = 1.0 / rig_.slotRate;
        for (int i = 0; i < count_; ++i)
            schedule.slots.push_back(
                {i, static_cast<double>(i) * duration, duration, {}, Dioptre::fromSi(powers_.mean(i)), {}});
        for (std::size_t l = 0; l < wishes_.size(); ++l) {
            // A level that cannot be held takes nothing from the others: the plan gives it up and schedules again.
            const double exposure = std::min(exposure_ > 0.0 ? exposure_ : 1.0, served_[l].exposure);
            Level level{wishes_[l].kind, wishes_[l].power, {}, exposure, {}, errorBudget(wishes_[l], wave_.rest, rig_)};
            level.rmsError = Dioptre::fromSi(std::sqrt(squareErrorOf(l, exposure)));
            eachSlot(l, exposure, [&](int slot, double weight) {
                level.slots.push_back(slot);
                Slot& lit = schedule.slots[static_cast<std::size_t>(slot)];
                if (lit.lit.empty())
                    lit.rmsError = Dioptre::fromSi(std::sqrt(powers_.squareError(slot, wishes_[l].power.si())));
                lit.lit.push_back({static_cast<int>(l), weight});
            });
            std::ranges::sort(level.slots);
            schedule.levels.push_back(std::move(level));
        }
        schedule.light = exposure_ / count_;
    }

private:
    double squareError(std::size_t level, int slot) const {
        return powers_.squareError(slot, wishes_[level].power.si());
    }

    /// True if no level of the other kind comes nearer.
    bool mayServe(std::size_t level, int slot) const {
        for (std::size_t other = 0; other < wishes_.size(); ++other) {
            if (wishes_[other].kind == wishes_[level].kind) continue;
            const double theirs = squareError(other, slot), ours = squareError(level, slot);
            if (theirs < ours || (theirs == ours && other < level)) return false;
        }
        return true;
    }

    Served served(std::size_t l) const {
        const LevelWish& wish = wishes_[l];
        Served result;
        std::vector<int> candidates;
        for (int slot = 0; slot < count_; ++slot) {
            if (mayServe(l, slot)) candidates.push_back(slot);
        }
        std::ranges::stable_sort(candidates, {}, [&](int slot) { return squareError(l, slot); });
        if (takesWhatThereIs() && !candidates.empty()) {
            const int nearest = candidates.front();
            const double best = squareError(l, nearest), budget = errorBudget(wish, wave_.rest, rig_).si();
            const bool sharp = wish.above && powers_.mean(nearest) <= wish.above->si() && wish.power != wave_.high;
            if (best > budget * budget && best < kWorstRecorded_D * kWorstRecorded_D && !sharp) return {{nearest}, 1.0};
        }
        const double allowed = std::pow(errorBudget(wish, wave_.rest, rig_).si(), 2);
        double sum = 0.0;
        for (const int slot : candidates) {
            const double error = squareError(l, slot), n = result.exposure;
            const bool endOfSweep = result.order.empty() && wish.power == wave_.high;
            if (wish.above && powers_.mean(slot) <= wish.above->si() && !endOfSweep) continue;
            if (sum + error <= allowed * (n + 1.0)) {
                sum += error;
                result.exposure += 1.0;
                result.order.push_back(slot);
                continue;
            }
            // sum + x error = allowed (n + x)
            const double part = (allowed * n - sum) / (error - allowed);
            if (!result.order.empty() && part > 0.0) {
                result.exposure += std::min(part, 1.0);
                result.order.push_back(slot);
            }
            break;
        }
        return result;
    }

    /// A recorded wave is the best there is, however wide: its extremes are what they are.
    bool takesWhatThereIs() const { return wave_.mode == WaveMode::paper || wave_.mode == WaveMode::slotAware; }

    template <class Take>
    void eachSlot(std::size_t level, double exposure, Take take) const {
        double left = exposure;
        for (const int slot : served_[level].order) {
            if (left <= 0.0) break;
            take(slot, std::min(1.0, left));
            left -= 1.0;
        }
    }

    double squareErrorOf(std::size_t level, double exposure) const {
        if (exposure <= 0.0) return 0.0;
        double sum = 0.0;
        eachSlot(level, exposure, [&](int slot, double weight) { sum += weight * squareError(level, slot); });
        return sum / exposure;
    }

    const Waveform& wave_;
    const Rig& rig_;
    const std::vector<LevelWish>& wishes_;
    int count_;
    SlotPowers powers_;
    std::vector<Served> served_;
    double exposure_ = 0.0;
};

/// Moving the wave costs nothing, but a plan whose slots lie as one expects is easier to read.
constexpr double kWorthMoving = 1.02;
constexpr int kDelays = 8;

double bestDelay(const Waveform& wave, const Rig& rig, const std::vector<LevelWish>& wishes) {
    const Scheduler still(wave, 0.0, rig, wishes);
    double best = 0.0, light = kWorthMoving * still.exposure(), errors = std::numeric_limits<double>::infinity();
    for (int i = 1; i < kDelays; ++i) {
        const double share = static_cast<double>(i) / kDelays;
        const double delay = (share > 0.5 ? share - 1.0 : share) / slotsPerSweep(rig);
        const Scheduler moved(wave, delay, rig, wishes);
        const bool brighter = moved.exposure() > light + 1e-9;
        const bool alike = best != 0.0 && std::abs(moved.exposure() - light) <= 1e-9;
        if (!brighter && !(alike && moved.squareErrors() < errors)) continue;
        best = delay;
        light = moved.exposure();
        errors = moved.squareErrors();
    }
    return best;
}

Schedule allLit(const Waveform& wave, const Rig& rig, const std::vector<LevelWish>& wishes) {
    const int count = slotsPerSweep(rig);
    Schedule schedule{wave, {}, {}, 1.0};
    const Second duration = 1.0 / rig.slotRate;
    const Dioptre error = abs(wave.low - wishes.front().power);
    for (const LevelWish& wish : wishes)
        schedule.levels.push_back({wish.kind, wish.power, {}, 0.0, {}, errorBudget(wish, wave.rest, rig)});
    Level& level = schedule.levels.front();
    level.exposure = count;
    level.rmsError = error;
    for (int i = 0; i < count; ++i) {
        schedule.slots.push_back({i, static_cast<double>(i) * duration, duration, {{0, 1.0}}, wave.low, error});
        level.slots.push_back(i);
    }
    return schedule;
}

}  // namespace

Dioptre errorBudget(const LevelWish& wish, Dioptre rest, const Rig& rig) {
    if (wish.kind == LevelKind::focus) return rig.powerBudget;
    return std::max(rig.powerBudget, rig.blurShare * abs(wish.power - rest));
}

Schedule scheduled(const Waveform& waveform, const Rig& rig, const std::vector<LevelWish>& wishes) {
    if (waveform.still()) return allLit(waveform, rig, wishes);
    const double delay = bestDelay(waveform, rig, wishes);
    Schedule schedule{waveform, {}, {}, 0.0};
    schedule.waveform.power = waveform.power.delayed(delay);
    schedule.waveform.drive = waveform.drive.delayed(delay);
    Scheduler(waveform, delay, rig, wishes).fill(schedule);
    return schedule;
}

}  // namespace ilf
