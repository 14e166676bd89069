#include "app/headless/evaluate_command.h"

#include <iostream>

#include "app/evaluate/report.h"
#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "projects/safe_file.h"

namespace ilf::app {

int evaluateCommand(const EvaluateCommandOptions& options) {
    // Asked first: nobody waits a minute to hear that the folder is no good.
    if (!options.folder.empty()) {
        const std::filesystem::path probe = std::filesystem::path(options.folder) / ".writable";
        auto writable = projects::makeFolders(options.folder);
        if (writable) writable = projects::writeAtomically(probe, "");
        if (!writable) return refused("evaluate", writable.error());
        projects::removeQuietly(probe);
    }
    const auto evaluation = evaluated({options.quick});
    if (!evaluation) return refused("evaluate", evaluation.error());
    std::cout << printed(*evaluation);
    if (options.folder.empty()) return kDone;
    if (const auto written = writeReport(options.folder, *evaluation); !written)
        return refused("evaluate", written.error());
    std::cout << "\n" << options.folder << "/report.md\n";
    return kDone;
}

}  // namespace ilf::app
