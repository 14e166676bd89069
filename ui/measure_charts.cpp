// The three charts below the measuring page: what is heard, powers at rest, the last wave.
#include <algorithm>

#include "ui/chart_frame.h"
#include "ui/measure_page.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

using Phase = MeasureView::State;

double lastOf(const std::vector<ChartPoint>& curve, double otherwise) {
    return curve.empty() ? otherwise : curve.back().x;
}

void heardChart(Panel& p, const MeasureView& m) {
    const Rect& area = p.at.sweep;
    beginPanel("###measureHeard", area, colour::panel, false);
    std::vector<ChartPoint> both = m.photodiode;
    both.insert(both.end(), m.input0.begin(), m.input0.end());
    const bool works = m.state == Phase::working;
    const std::string summary = m.photodiode.empty() ? "nothing heard yet"
                                : works              ? "photodiode, and AI0 dashed"
                                                     : "photodiode as last heard, AI0 dashed";
    const ChartFrame frame = chartFrame(p, area, "HEARD", summary, {0.0, std::max(1.0, lastOf(m.photodiode, 50.0))},
                                        rangeOf(both, 0.1), "ms", "V");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    chartCurve(draw, frame, m.input0, faded(colour::dim, 0.9), p.px(1.2), true);
    chartCurve(draw, frame, m.photodiode, works ? colour::focus : colour::text, p.px(1.6));
    ImGui::End();
}

void powersChart(Panel& p, const MeasureView& m) {
    const Rect& area = p.at.blurRange;
    beginPanel("###measurePowers", area, colour::panel, false);
    std::string summary = "not measured yet";
    ChartRange across{-100.0, 100.0};
    if (!m.powers.empty()) {
        summary = std::to_string(m.powers.size()) + " currents" + (m.known.empty() ? "" : ", rings known before");
        across = {m.powers.front().x, m.powers.back().x};
    }
    std::vector<ChartPoint> both = m.powers;
    both.insert(both.end(), m.known.begin(), m.known.end());
    const ChartFrame frame =
        chartFrame(p, area, "AT REST  power by current", summary, across, rangeOf(both, 1.0), "mA", "D");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    chartCurve(draw, frame, m.powers, colour::text, p.px(1.6));
    for (const ChartPoint& one : m.powers)
        draw.AddCircleFilled(frame.at(one.x, one.y), p.px(2), colour::text);
    for (const ChartPoint& one : m.known)
        draw.AddCircle(frame.at(one.x, one.y), p.px(4.5), colour::focus, 0, p.px(1.4));
    ImGui::End();
}

void waveChart(Panel& p, const MeasureView& m) {
    const Rect& area = p.at.seam;
    beginPanel("###measureWave", area, colour::panel, false);
    const std::string summary = m.wave.empty() ? "none recorded yet" : m.waveName;
    const ChartFrame frame = chartFrame(p, area, "WAVE  power as recorded", summary, {0.0, lastOf(m.wave, 16.7)},
                                        rangeOf(m.wave, 0.5), "ms", "D");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    // The drive has another unit: only its shape and place are drawn.
    if (!m.drive.empty()) {
        const ChartRange of = rangeOf(m.drive, 1e-6);
        std::vector<ChartPoint> shape = m.drive;
        for (ChartPoint& one : shape)
            one.y = frame.y.at(of.shareOf(one.y));
        chartCurve(draw, frame, shape, faded(colour::dim, 0.9), p.px(1.2), true);
        const double row = static_cast<double>(font(Font::small)->FontSize) + 6 * p.scale;
        draw.AddText(font(Font::small), font(Font::small)->FontSize,
                     vec(frame.plot.x + 8 * p.scale, frame.plot.bottom() - row), colour::dim,
                     "dashed: its drive, in shape");
    }
    chartCurve(draw, frame, m.wave, colour::good, p.px(1.8));
    ImGui::End();
}

}  // namespace

ChartRange rangeOf(const std::vector<ChartPoint>& curve, double atLeast) {
    if (curve.empty()) return {0.0, atLeast};
    const auto [low, high] =
        std::minmax_element(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    const double middle = 0.5 * (low->y + high->y), half = 0.55 * std::max(high->y - low->y, atLeast);
    return {middle - half, middle + half};
}

void measureCharts(Panel& p, const MeasureView& m) {
    heardChart(p, m);
    powersChart(p, m);
    waveChart(p, m);
}

}  // namespace ilf::ui
