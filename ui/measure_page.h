// The wizard that measures a rig: step by step over the picture, with what is heard meanwhile.
#pragma once

#include "ui/measure_view.h"
#include "ui/panel.h"

namespace ilf::ui {

/// In place of the picture and the charts while `View::measuring` is set; top bar and Rig stay beside it.
void measurePage(Panel& p);
/// In place of the three charts below it.
void measureCharts(Panel& p, const MeasureView& m);
/// The button of Rig that leads there, and why it cannot.
void measureButton(Panel& p);

/// Why this core's rig cannot be measured, and what would help; empty: it can.
std::string whyNotMeasured(const CoreStatus& core);
/// "waiting", "good", "not good", ...
std::string word(MeasureStanding standing);
/// Values with a margin above and below; never empty.
ChartRange rangeOf(const std::vector<ChartPoint>& curve, double atLeast);

}  // namespace ilf::ui
