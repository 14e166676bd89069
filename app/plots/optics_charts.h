// The paper's figures of the optics, drawn from the checked formulas.
#pragma once

#include <optional>
#include <string>

#include "app/plots/chart.h"

namespace ilf::app {

/// far-border: least power that blurs against distance, for three pupils and three circles of confusion (the paper's
/// "blur range" figure, its far border). near-border: both borders against power, for three amplitudes of
/// accommodation. blur: blur circle in arcmin against power, for five distances. scale: s against power, for five
/// distances. Of the reference eye (60 D, 4 mm pupil, 20 mm from the lens, 1 arcmin) but for what a curve's label says.
/// None: another name.
std::optional<Chart> opticsChart(const std::string& name);

}  // namespace ilf::app
