// How much light a plan could have if its power were allowed to err more or less, and what would give it more.
#pragma once

#include <string>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

/// One choice of Rig::powerBudget on the plan's own wave.
struct LightPoint {
    Dioptre budget;
    double light = 0.0;  ///< share of steady light; 0: some level has no slot
    Dioptre rmsError;    ///< the largest of all levels
};
/// `points` budgets from 0.01 to 1 D, evenly in their logarithm. Empty for a lens that stands still.
std::vector<LightPoint> lightCurve(const Plan& plan, int points = 24);

/// Sentences on what would help, each planned for real and only said where it gains 2 % of light or more: the driving
/// region moved, more error allowed, more alpha.
std::vector<std::string> whatWouldHelp(const Plan& plan);

/// One sentence: what decides how far the lens sweeps.
std::string whyThisSweep(const Plan& plan);

}  // namespace ilf
