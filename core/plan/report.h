// What a plan has to say for itself, worked out beside it: reasons, help, notes and the choice between light and error.
#pragma once

#include "core/plan/light_curve.h"
#include "core/plan/notes.h"

namespace ilf {

struct PlanReport {
    std::string why;                ///< what decides how far the lens sweeps
    std::vector<std::string> help;  ///< what would give more light
    std::vector<PlanNote> notes;
    std::vector<LightPoint> curve;  ///< light by allowed error, on the plan's wave
};
/// A few plans' worth of work.
PlanReport planReport(const Plan& plan);

}  // namespace ilf
