// The frame around a chart: heading, axes with units, and the way from values to window pixels.
#pragma once

#include <imgui.h>

#include <cmath>
#include <string>

#include "ui/charts.h"
#include "ui/panel.h"
#include "ui/theme.h"

namespace ilf::ui {

struct ChartFrame {
    Rect plot;
    ChartRange x, y;
    bool logX = false;

    double shareX(double value) const {
        return logX ? std::log(value / x.low) / std::log(x.high / x.low) : x.shareOf(value);
    }
    ImVec2 at(double vx, double vy) const {
        return {static_cast<float>(plot.x + shareX(vx) * plot.w),
                static_cast<float>(plot.bottom() - y.shareOf(vy) * plot.h)};
    }
    double xAt(double pixel) const {
        const double share = (pixel - plot.x) / plot.w;
        return logX ? x.low * std::pow(x.high / x.low, share) : x.at(share);
    }
};

/// Heading, grid and axes inside the current window.
ChartFrame chartFrame(Panel& p, const Rect& area, const char* heading, const std::string& summary, ChartRange x,
                      ChartRange y, const char* xUnit, const char* yUnit, bool logX = false);
void chartCurve(ImDrawList& draw, const ChartFrame& frame, const std::vector<ChartPoint>& curve, ImU32 ink, float width,
                bool dashed = false);
void chartNote(Panel& p, ImDrawList& draw, ImVec2 at, const std::string& words, ImU32 ink);

}  // namespace ilf::ui
