// The scheduler: which slots of a wave serve which level, with how much light.
#pragma once

#include <optional>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

/// A level that has no slots yet.
struct LevelWish {
    LevelKind kind = LevelKind::focus;
    Dioptre power;
    /// Blur only: a slot whose mean power is below this would show a region sharp that must be blurred. It is left out,
    /// except the best one of the end of the sweep.
    std::optional<Dioptre> above;
    bool operator==(const LevelWish&) const = default;
};

struct Schedule {
    Waveform waveform;  ///< delayed by up to half a slot against the one asked for
    std::vector<Slot> slots;
    std::vector<Level> levels;  ///< as the wishes; one without slots is a level the wave cannot hold
    double light = 1.0;         ///< every level's luminance as a share of steady light
};

/// The rms power error a level may have: Rig::powerBudget, for blur at least blurShare of its power above rest.
Dioptre errorBudget(const LevelWish& wish, Dioptre rest, const Rig& rig);

/// For each level a fractional knapsack (scheduling 3.1): slots in order of their square error, taken while the common
/// rms stays in the budget, the last one in part. That is the most light the level can have. All levels then get as
/// much as the one with least, each in its own best slots: equal luminance, and less error where there was light to
/// spare. A slot may serve several levels of one kind, never focus and blur together: where their seams meet, the sum
/// would be more than all light. The wave is moved against the slots by up to half a slot if that gives 2 % more light.
/// With a recorded wave (paper, slotAware) a level whose best slot is over the budget gets that one all the same, up to
/// 0.5 D: the plan warns of it. A lens that stands still serves the first level in every slot.
Schedule scheduled(const Waveform& waveform, const Rig& rig, const std::vector<LevelWish>& wishes);

}  // namespace ilf
