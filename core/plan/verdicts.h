// What the lens can do for each region: whether it can be seen sharp or blurred, and the sentence where it cannot.
#pragma once

#include <vector>

#include "core/plan/focus_levels.h"
#include "core/plan/plan.h"

namespace ilf {

/// Refuses numbers no plan can be made from: distances, alpha, strengths, rates, a rest power beyond the lens.
Result<void> checkedInput(const PlanInput& input);

/// Where the lens rests: the prescription offset; 0 D for a camera, whose focus is its own.
Dioptre restOf(const PlanInput& input);

/// Focus levels of the objects that can be seen sharp, and the level of each object (by its index in the input).
/// Objects that cannot are given the level that comes nearest, with `problem` and `help` in `regions`.
struct FocusVerdict {
    std::vector<Dioptre> powers;        ///< ascending, never empty: the rest power if nothing is focused
    std::vector<std::size_t> ofObject;  ///< for focused objects only; 0 for others
    std::size_t main = 0;               ///< the level nearest the rest power
};
FocusVerdict focusVerdict(const PlanInput& input, std::vector<RegionPlan>& regions);

/// What a blurred region asks of the sweep.
struct BlurWish {
    bool needsSweep = false;       ///< false: lit at the focus level (already blurred), or it cannot be blurred
    std::optional<Dioptre> power;  ///< with a strength: its own level; without: the end of the sweep
};
/// Fills `pMin`, `alreadyBlurred`, and `problem` and `help` where the lens cannot reach.
BlurWish blurWish(const PlanInput& input, const PlanObject& object, Dioptre focusPower, RegionPlan& region);

}  // namespace ilf
