#include "app/headless/validate_command.h"

#include <iostream>

#include "app/exit_code.h"
#include "app/headless/prepare.h"

namespace ilf::app {

int validateCommand(const std::string& file, const LensChoice& lens) {
    const auto project = prepared(file, lens);
    if (!project) return refused("validate", project.error());
    if (const auto fits = checked(project->compiled.program); !fits) return refused("validate", fits.error());
    const Plan& plan = project->compiled.plan;
    int problems = 0;
    for (const RegionPlan& region : plan.regions) {
        if (region.problem.empty()) continue;
        ++problems;
        std::cout << "problem: \"" << region.name << "\": " << region.problem;
        if (!region.help.empty()) std::cout << ' ' << region.help;
        std::cout << '\n';
    }
    for (const std::string& warning : plan.warnings)
        std::cout << "warning: " << warning << '\n';
    std::cout << file << ": " << plan.regions.size() << " surfaces, " << plan.levels.size() << " levels, " << problems
              << " problems, " << plan.warnings.size() << " warnings\n";
    return problems == 0 ? kDone : kFailed;
}

}  // namespace ilf::app
