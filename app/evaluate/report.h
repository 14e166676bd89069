// The evaluation as a report: beside every value what the paper says of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/evaluate/evaluate.h"
#include "app/plots/chart.h"

namespace ilf::app {

/// One line of the summary: what was measured here, what the paper states, and what is to be said about both.
struct Finding {
    std::string what, ours, paper, remark;
};
std::vector<Finding> findings(const Evaluation& evaluation);

/// Short, for a terminal.
std::string printed(const Evaluation& evaluation);
/// The whole report; pictures and charts lie beside it under the names that writeReport gives them.
std::string markdown(const Evaluation& evaluation);
std::string json(const Evaluation& evaluation);

/// Radius against power; swept less fixed; far border against distance.
Chart blurSizeChart(const BlurSizes& sizes);
Chart blurDifferenceChart(const BlurSizes& sizes);
Chart blurRangeChart(const BlurRange& range);

/// Writes report.md, report.json, the charts and the pictures into `folder`, which is made if it is missing.
Result<void> writeReport(const std::filesystem::path& folder, const Evaluation& evaluation);

}  // namespace ilf::app
