// Charts as files: PNG to look at, SVG to print.
#pragma once

#include <filesystem>
#include <string>

#include "app/plots/chart.h"
#include "core/base/result.h"

namespace ilf::app {

/// 900 x 560 units; a PNG has two pixels a unit. Dark on white, legend beside the plot.
Result<std::string> pngOf(const Chart& chart);
Result<std::string> svgOf(const Chart& chart);

/// By the file's ending, .png or .svg; others are refused. Written atomically.
Result<void> writeChart(const std::filesystem::path& path, const Chart& chart);

}  // namespace ilf::app
