// `plan`: what the lens must do for a project or for objects named on the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/lens/rig_choice.h"
#include "core/plan/plan.h"

namespace ilf::app {

struct PlanOptions {
    std::string file;
    std::vector<std::string> objects;  ///< "NAME,DISTANCE_M,focus|blur|neutral"
    std::optional<double> alpha_D;
    std::string coc;  ///< 1arcmin, dof, landolt, or metres; empty: the project's, or 1arcmin
    RigChoice rig;
    bool json = false;
};

/// Prints the plan and returns the exit code.
int planCommand(const PlanOptions& options);

/// The plan and what each region is predicted to look like, as JSON text; the keys are part of the stable interface.
/// `document`: what was planned, or, for objects alone, an empty one with their wearer, rig and blending.
std::string planJson(const Plan& plan, const Document& document);
/// The same in words, for people.
std::string planText(const Plan& plan, const Document& document);

}  // namespace ilf::app
