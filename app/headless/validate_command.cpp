#include "app/headless/validate_command.h"

#include <iostream>
#include <string>
#include <vector>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "core/plan/notes.h"

namespace ilf::app {

int validateCommand(const std::string& file, const RigChoice& rig) {
    const auto project = prepared(file, rig);
    if (!project) return refused("validate", project.error());
    if (const auto fits = checked(project->compiled.program); !fits) return refused("validate", fits.error());
    const Plan& plan = project->compiled.plan;
    int problems = 0;
    for (const RegionPlan& region : plan.regions) {
        if (region.problem.empty()) continue;
        ++problems;
        std::cout << "problem: " << region.problem;
        if (!region.help.empty()) std::cout << ' ' << region.help;
        std::cout << '\n';
    }
    std::vector<std::string> warnings = plan.warnings;
    for (const PlanNote& note : planNotes(plan)) {
        if (note.warns) warnings.push_back(note.text);
    }
    for (const std::string& warning : warnings)
        std::cout << "warning: " << warning << '\n';
    std::cout << file << ": surfaces " << plan.regions.size() << ", levels " << plan.levels.size() << ", problems "
              << problems << ", warnings " << warnings.size() << '\n';
    return problems == 0 ? kDone : kFailed;
}

}  // namespace ilf::app
