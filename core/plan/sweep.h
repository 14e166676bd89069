// The sweep of a plan: its wave, and what happens where the lens does not reach far enough.
#pragma once

#include "core/plan/parts.h"

namespace ilf {

/// Chooses waves and makes schedules for one plan; takes both from the plan before where nothing they depend on
/// changed.
class SweepPlanner {
public:
    SweepPlanner(const PlanInput& input, Dioptre rest, const Plan* previous);

    /// The wave for `low` to `high` with light at `levels` (ascending). Without a calibration an ideal sine; where a
    /// shaped wave is asked for and there is none, the continuous one, and `unshaped()` says why.
    const WaveChoice& wave(Dioptre low, Dioptre high, std::vector<Dioptre> levels);
    /// Precondition: the last `wave` found one.
    const Schedule& schedule(const std::vector<LevelWish>& wishes);

    const std::string& unshaped() const { return parts_.unshaped; }
    /// The levels that the missing shaped wave would hold; empty: none is missing.
    std::vector<Dioptre> unlearnt() const { return unshaped().empty() ? std::vector<Dioptre>() : parts_.wish.levels; }
    const PlanWork& work() const { return work_; }
    std::shared_ptr<const PlanParts> parts() const { return std::make_shared<const PlanParts>(parts_); }

private:
    WaveChoice chosen(const WaveWish& wish);

    const PlanInput& input_;
    Dioptre rest_;
    PlanParts before_;  ///< of the plan before: schedules are taken from it when they are asked for
    PlanParts parts_;
    bool known_ = false;  ///< parts_ hold a choice
    PlanWork work_;
};

}  // namespace ilf
