// `evaluate`: the paper's evaluation on the simulated system, printed and as a report.
#pragma once

#include <string>

namespace ilf::app {

struct EvaluateCommandOptions {
    std::string folder;  ///< for report.md, report.json, charts and pictures; empty: only printed
    bool quick = false;
};
int evaluateCommand(const EvaluateCommandOptions& options);

}  // namespace ilf::app
