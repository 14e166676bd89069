#include "ui/charts.h"

#include <algorithm>
#include <cmath>

namespace ilf::ui {

namespace {

constexpr int kCurvePoints = 128;

ChartRange padded(double low, double high, double least) {
    if (high - low < least) {
        const double middle = (low + high) / 2;
        low = middle - least / 2;
        high = middle + least / 2;
    }
    const double margin = 0.1 * (high - low);
    return {low - margin, high + margin};
}

}  // namespace

SweepChart sweepChart(const Plan& plan) {
    SweepChart chart;
    const double period = 1e3 / plan.waveform.rate.si();
    chart.time_ms = {0.0, period};
    double low = plan.waveform.low.si(), high = plan.waveform.high.si();
    for (const Level& level : plan.levels) {
        chart.levels.push_back({level.kind, level.power.si(), level.rmsError.si()});
        low = std::min(low, level.power.si());
        high = std::max(high, level.power.si());
    }
    chart.power_D = padded(low, high, 0.5);
    for (int i = 0; i <= kCurvePoints; ++i) {
        const double t = period * i / kCurvePoints;
        chart.curve.push_back({t, plan.waveform.powerAt(Second::fromSi(t * 1e-3)).si()});
    }
    for (const Slot& slot : plan.slots) {
        SweepChart::Bar bar{slot.index,      slot.start.si() * 1e3, (slot.start + slot.duration).si() * 1e3,
                            slot.power.si(), std::nullopt,          0.0};
        if (const auto lit = slot.level()) {
            const Level& level = plan.levels[static_cast<std::size_t>(*lit)];
            bar.kind = level.kind;
            bar.error_D = (slot.power - level.power).si();
        }
        chart.bars.push_back(bar);
    }
    return chart;
}

BlurRangeChart blurRangeChart(const Plan& plan, const Wearer& wearer) {
    BlurRangeChart chart;
    double near = 0.2, far = 4.0;
    for (const RegionPlan& region : plan.regions) {
        if (isFinite(region.nearest) && region.nearest > 0.0_m) near = std::min(near, region.nearest.si() * 0.7);
        if (isFinite(region.farthest)) far = std::max(far, region.farthest.si() * 1.3);
    }
    chart.distance_m = {std::max(near, 0.05), std::min(far, 100.0)};
    chart.top_D = plan.waveform.high.si();
    if (plan.pS) chart.pS_D = plan.pS->si();
    double high = std::max(chart.top_D, plan.focusPower.si());
    for (const RegionPlan& region : plan.regions) {
        if (!isFinite(region.nearest)) continue;
        BlurRangeChart::Object object{region.id,
                                      region.name,
                                      region.look,
                                      region.nearest.si(),
                                      region.farthest.si(),
                                      plan.focusPower.si(),
                                      std::nullopt,
                                      plan.driver == region.id};
        if (region.look != Look::neutral) object.power_D = region.levelPower.si();
        if (region.pMin) object.pMin_D = region.pMin->si();
        high = std::max(high, object.power_D);
        chart.objects.push_back(std::move(object));
    }
    chart.power_D = padded(std::min(0.0, plan.waveform.low.si()), high, 1.0);

    const EyeOptics eye = eyeOptics(wearer);
    const Carried nearOffset = nearBorderOffset(eye);
    const double ratio = chart.distance_m.high / chart.distance_m.low;
    for (int i = 0; i <= kCurvePoints; ++i) {
        const double d = chart.distance_m.low * std::pow(ratio, static_cast<double>(i) / kCurvePoints);
        chart.farBorder.push_back({d, 1.0 / d + plan.farOffset.si()});
        if (nearOffset.reachesLens) chart.nearBorder.push_back({d, 1.0 / d + nearOffset.power.si()});
    }
    return chart;
}

SeamChart seamChart(const SeamProfile& profile) {
    SeamChart chart;
    if (profile.millimetres.empty()) return chart;
    chart.across_mm = {static_cast<double>(profile.millimetres.front()),
                       static_cast<double>(profile.millimetres.back())};
    double low = 0.9, high = 1.1;
    const auto curve = [&](const std::vector<float>& light) {
        std::vector<ChartPoint> points;
        for (std::size_t i = 0; i < std::min(light.size(), profile.millimetres.size()); ++i) {
            const auto value = static_cast<double>(light[i]);
            points.push_back({static_cast<double>(profile.millimetres[i]), value});
            low = std::min(low, value);
            high = std::max(high, value);
        }
        return points;
    };
    chart.leftBefore = curve(profile.left.before);
    chart.leftAfter = curve(profile.left.after);
    chart.rightBefore = curve(profile.right.before);
    chart.rightAfter = curve(profile.right.after);
    chart.light = padded(low, high, 0.2);
    chart.worstBefore = std::max(profile.left.worstWeberBefore, profile.right.worstWeberBefore);
    chart.worstAfter = std::max(profile.left.worstWeberAfter, profile.right.worstWeberAfter);
    return chart;
}

std::vector<double> ticks(ChartRange range, int most) {
    std::vector<double> at;
    const double span = range.high - range.low;
    if (!(span > 0.0) || !std::isfinite(span) || most < 1) return at;
    double step = std::pow(10.0, std::floor(std::log10(span / most)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        if (span / (step * factor) <= most) {
            step *= factor;
            break;
        }
    }
    for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * step; k += 1.0) {
        at.push_back(k == 0.0 ? 0.0 : k * step);
    }
    return at;
}

std::optional<double> valueAt(const std::vector<ChartPoint>& curve, double x) {
    const auto after = std::find_if(curve.begin(), curve.end(), [&](const ChartPoint& p) { return p.x >= x; });
    if (after == curve.end() || curve.empty()) return std::nullopt;
    if (after == curve.begin()) return after->x == x ? std::optional(after->y) : std::nullopt;
    const ChartPoint& before = *(after - 1);
    const double share = after->x > before.x ? (x - before.x) / (after->x - before.x) : 0.0;
    return before.y + share * (after->y - before.y);
}

}  // namespace ilf::ui
