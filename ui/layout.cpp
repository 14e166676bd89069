#include "ui/layout.h"

#include <algorithm>
#include <cmath>

namespace ilf::ui {

namespace {

constexpr double kTop = 56, kTools = 52, kHeader = 36, kStatus = 28, kGrip = 6;
constexpr double kMinSide = 260, kMinCharts = 120, kMinCanvas = 320, kMinList = 110;
/// Above this the selected region has a panel of its own.
constexpr double kRoomForSelected = 700;

}  // namespace

Layout layout(Size window, double scale, const PanelSizes& sizes, bool onePage) {
    // Whole pixels, so that no hairline of the ground shows between panels.
    const auto px = [&](double value) { return std::round(value * scale); };
    const double width = std::max(0, window.width), height = std::max(0, window.height);
    Layout at;
    at.top = {0, 0, width, std::min(px(kTop), height)};
    if (sizes.hidden) {
        at.canvas = {0, at.top.bottom(), width, height - at.top.bottom()};
        return at;
    }
    const double statusHeight = std::min(px(kStatus), height - at.top.h);
    at.status = {0, height - statusHeight, width, statusHeight};

    const double middle = at.status.y - at.top.bottom();
    const double mostCharts = std::max(0.0, middle - px(kHeader + 200));
    double charts = std::min(px(std::max(sizes.charts, kMinCharts)), mostCharts);
    if (onePage || charts < px(kMinCharts * 0.75)) charts = 0;
    const double chartsTop = at.status.y - charts;

    const double mostSide = std::max(0.0, width - px(kTools + kMinCanvas));
    const double side = std::min(px(std::max(sizes.side, kMinSide)), mostSide);
    const double sideLeft = width - side;

    const double toolsWidth = onePage ? 0.0 : std::min(px(kTools), width);
    at.tools = {0, at.top.bottom(), toolsWidth, chartsTop - at.top.bottom()};
    at.header = {toolsWidth, at.top.bottom(), std::max(0.0, sideLeft - toolsWidth),
                 onePage ? 0.0 : std::min(px(kHeader), middle)};
    at.canvas = {toolsWidth, at.header.bottom(), at.header.w, std::max(0.0, chartsTop - at.header.bottom())};

    const double column = chartsTop - at.top.bottom();
    const double list = std::round(std::clamp(sizes.regions, 0.15, 0.6) * column);
    const double listHeight = std::min(std::max(list, px(kMinList)), column);
    at.regions = {sideLeft, at.top.bottom(), side, listHeight};
    const double rest = column - listHeight;
    const bool own = column >= px(kRoomForSelected);
    const double selected = own ? std::round(rest * 0.58) : 0.0;
    at.selected = own ? Rect{sideLeft, at.regions.bottom(), side, selected} : Rect{};
    at.pages = {sideLeft, at.regions.bottom() + selected, side, rest - selected};

    if (charts > 0) {
        const double first = std::round(width * 0.36), second = std::round(width * 0.32);
        at.sweep = {0, chartsTop, first, charts};
        at.blurRange = {first, chartsTop, second, charts};
        at.seam = {first + second, chartsTop, width - first - second, charts};
        at.chartSplitter = {0, chartsTop - px(kGrip / 2), width, px(kGrip)};
    }
    at.sideSplitter = {sideLeft - px(kGrip / 2), at.top.bottom(), px(kGrip), column};
    at.regionsSplitter = {sideLeft + px(kGrip), at.regions.bottom() - px(kGrip / 2), side - px(kGrip), px(kGrip)};
    return at;
}

}  // namespace ilf::ui
