#include "ui/chart_frame.h"

#include <array>
#include <cstdio>

#include "ui/widgets.h"

namespace ilf::ui {

namespace {

std::string tickText(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", value);
    return text.data();
}

}  // namespace

ChartFrame chartFrame(Panel& p, const Rect& area, const char* title, const std::string& summary, ChartRange x,
                      ChartRange y, const char* xUnit, const char* yUnit, bool logX) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImFont* small = font(Font::small);
    const double line = static_cast<double>(small->FontSize);
    ChartFrame frame;
    frame.plot = {area.x + 40 * p.scale, area.y + line + 18 * p.scale, area.w - 56 * p.scale,
                  area.h - 2 * line - 32 * p.scale};
    frame.x = x;
    frame.y = y;
    frame.logX = logX;
    draw.AddText(small, small->FontSize, vec(area.x + 14 * p.scale, area.y + 9 * p.scale), colour::dim, title);
    const ImVec2 extent = small->CalcTextSizeA(small->FontSize, 4096, 0, summary.c_str());
    draw.AddText(small, small->FontSize,
                 vec(area.right() - 16 * p.scale - static_cast<double>(extent.x), area.y + 9 * p.scale), colour::text,
                 summary.c_str());
    const auto label = [&](double px, double py, const std::string& words, bool right) {
        const ImVec2 size = small->CalcTextSizeA(small->FontSize, 4096, 0, words.c_str());
        const double left = right ? px - static_cast<double>(size.x) : px - static_cast<double>(size.x) / 2;
        draw.AddText(small, small->FontSize, vec(left, py), rgb(0x66707E), words.c_str());
    };
    const std::vector<double> rows = ticks(y, static_cast<int>(frame.plot.h / (24 * p.scale)));
    for (const double value : rows) {
        const ImVec2 at = frame.at(x.low, value);
        draw.AddLine(at, {static_cast<float>(frame.plot.right()), at.y}, rgb(0x232931));
        // The highest mark carries the unit.
        const std::string words =
            tickText(value) + (value == rows.back() && *yUnit != 0 ? std::string(" ") + yUnit : "");
        label(static_cast<double>(at.x) - 6 * p.scale, static_cast<double>(at.y) - line / 2, words, true);
    }
    const double below = frame.plot.bottom() + 4 * p.scale;
    std::vector<double> marks;
    if (logX) {
        for (const double value : {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
            if (value >= x.low && value <= x.high) marks.push_back(value);
        }
    } else {
        marks = ticks(x, static_cast<int>(frame.plot.w / (56 * p.scale)));
    }
    for (const double value : marks) {
        const ImVec2 at = frame.at(value, y.low);
        draw.AddLine({at.x, static_cast<float>(frame.plot.y)}, at, rgb(0x1D232B));
        // The last mark makes room for the unit.
        if (static_cast<double>(at.x) < frame.plot.right() - 26 * p.scale)
            label(static_cast<double>(at.x), below, tickText(value), false);
    }
    label(frame.plot.right() + 4 * p.scale, below, xUnit, true);
    draw.AddRect(vec(frame.plot.x, frame.plot.y), vec(frame.plot.right(), frame.plot.bottom()), rgb(0x2C333D));
    return frame;
}

void chartCurve(ImDrawList& draw, const ChartFrame& frame, const std::vector<ChartPoint>& curve, ImU32 ink, float width,
                bool dashed) {
    if (curve.size() < 2) return;
    draw.PushClipRect(vec(frame.plot.x, frame.plot.y), vec(frame.plot.right(), frame.plot.bottom()), true);
    if (dashed) {
        for (std::size_t i = 0; i + 1 < curve.size(); i += 2) {
            draw.AddLine(frame.at(curve[i].x, curve[i].y), frame.at(curve[i + 1].x, curve[i + 1].y), ink, width);
        }
    } else {
        for (const ChartPoint& point : curve)
            draw.PathLineTo(frame.at(point.x, point.y));
        draw.PathStroke(ink, 0, width);
    }
    draw.PopClipRect();
}

void chartNote(Panel& p, ImDrawList& draw, ImVec2 at, const std::string& words, ImU32 ink) {
    ImFont* small = font(Font::small);
    const ImVec2 size = small->CalcTextSizeA(small->FontSize, 4096, 0, words.c_str());
    const ImVec2 window = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    at.x = std::min(at.x, window.x + extent.x - size.x - p.px(10));
    at.y = std::max(at.y, window.y + p.px(4));
    draw.AddRectFilled({at.x - p.px(5), at.y - p.px(2)}, {at.x + size.x + p.px(5), at.y + size.y + p.px(2)},
                       rgb(0x0C0F12, 235), p.px(3));
    draw.AddText(small, small->FontSize, at, ink, words.c_str());
}

}  // namespace ilf::ui
