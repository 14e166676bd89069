// The three charts below the picture, drawn from their records.
#include <algorithm>

#include "ui/canvas.h"
#include "ui/chart_frame.h"
#include "ui/icons.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

ImU32 levelColour(LevelKind kind) { return kind == LevelKind::focus ? colour::focus : colour::blur; }

std::string number(double value, int digits) {
    std::string text = std::to_string(value);
    return text.substr(0, text.find('.') + static_cast<std::size_t>(digits) + (digits > 0 ? 1U : 0U));
}

bool hovering(const ChartFrame& frame) {
    const ImVec2 mouse = ImGui::GetMousePos();
    return ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) &&
           frame.plot.holds({mouse.x, mouse.y});
}

void drawSweep(Panel& p, const Plan& plan) {
    const SweepChart chart = sweepChart(plan);
    std::string summary = plan.sweeps() ? formatted(plan.waveform.low) + " to " + formatted(plan.waveform.high)
                                        : "lens at rest, " + formatted(plan.waveform.low);
    summary += ", light " + formatted(plan.light, Unit::percent);
    if (p.view.core.simulated) summary += ", simulated lens";
    const ChartFrame frame =
        chartFrame(p, p.at.sweep, "SWEEP  lens power", summary, chart.time_ms, chart.power_D, "ms", "D");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto bottom = static_cast<float>(frame.plot.bottom());
    for (const auto& bar : chart.bars) {
        if (!bar.kind) continue;
        const float x0 = frame.at(bar.start_ms, 0).x, x1 = frame.at(bar.end_ms, 0).x;
        const bool shown = p.state.mode == ViewMode::light && p.state.slot == bar.slot;
        draw.AddRectFilled({x0 + 0.5f, frame.at(0, bar.power_D).y}, {x1 - 0.5f, bottom},
                           faded(levelColour(*bar.kind), shown ? 0.5 : 0.2));
        // The foot of a bar says its look by pattern too: dots for focus, a solid edge for blur.
        draw.AddRectFilled({x0 + 0.5f, bottom - p.px(3)}, {x1 - 0.5f, bottom}, faded(levelColour(*bar.kind), 0.9));
    }
    for (const auto& level : chart.levels) {
        const ImVec2 at = frame.at(chart.time_ms.low, level.power_D);
        draw.AddLine(at, {static_cast<float>(frame.plot.right()), at.y}, faded(levelColour(level.kind), 0.8), p.px(1));
    }
    chartCurve(draw, frame, chart.curve, colour::text, p.px(1.8));
    if (!hovering(frame)) return;
    const double mouse = static_cast<double>(ImGui::GetMousePos().x), t = frame.xAt(mouse);
    draw.AddLine(vec(mouse, frame.plot.y), vec(mouse, frame.plot.bottom()), rgb(0xffffff, 60));
    std::string words = number(t, 2) + " ms";
    if (const auto power = valueAt(chart.curve, t)) words += "   " + formatted(*power, Unit::dioptre);
    for (const auto& bar : chart.bars) {
        if (t < bar.start_ms || t >= bar.end_ms) continue;
        words += "   slot " + std::to_string(bar.slot);
        words += bar.kind ? (*bar.kind == LevelKind::focus ? " focus, error " : " blur, error ") +
                                formatted(bar.error_D, Unit::dioptre)
                          : " dark";
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
            p.state.slot = bar.slot;
            p.state.mode = ViewMode::light;
        }
    }
    chartNote(p, draw, vec(mouse + 10 * p.scale, frame.plot.y + 4 * p.scale), words, colour::text);
}

void dragObject(Panel& p, const ChartFrame& frame, const BlurRangeChart::Object& object) {
    const Region* region = findRegion(p.document(), object.id);
    if (region == nullptr || !ImGui::IsItemActive() || !ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) return;
    const double to = std::clamp(frame.xAt(static_cast<double>(ImGui::GetMousePos().x)), frame.x.low, frame.x.high);
    if (const auto distance = scaled(region->distance, to / object.nearest_m)) {
        p.preview(SetDistance{object.id, *distance});
        p.state.hintsUsed.insert(Hint::distance);
    }
}

void drawBlurRange(Panel& p, const Plan& plan) {
    BlurRangeChart chart = blurRangeChart(plan, p.document().wearer);
    // The axis must not run away under the pointer while a point is dragged.
    ImGuiStorage& kept = *ImGui::GetStateStorage();
    const ImGuiID keepLow = ImGui::GetID("###low"), keepHigh = ImGui::GetID("###high");
    const bool dragging = ImGui::IsAnyItemActive() && ImGui::IsWindowFocused();
    if (dragging && kept.GetFloat(keepHigh, 0.0f) > 0.0f) {
        chart.distance_m = {static_cast<double>(kept.GetFloat(keepLow)), static_cast<double>(kept.GetFloat(keepHigh))};
    } else {
        kept.SetFloat(keepLow, static_cast<float>(chart.distance_m.low));
        kept.SetFloat(keepHigh, static_cast<float>(chart.distance_m.high));
    }
    std::string summary = "nothing to blur";
    if (plan.driver && plan.pS) {
        const Region* driver = findRegion(p.document(), *plan.driver);
        summary = std::string(hasIcons() ? icon::star : "*") + " " + (driver != nullptr ? driver->name : "") +
                  " drives, P_s " + formatted(*plan.pS);
    }
    const ChartFrame frame = chartFrame(p, p.at.blurRange, "BLUR RANGE  power by distance", summary, chart.distance_m,
                                        chart.power_D, "m", "D", true);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(vec(frame.plot.x, frame.plot.y), vec(frame.plot.right(), frame.plot.bottom()), true);
    const auto top = static_cast<float>(frame.plot.y), bottom = static_cast<float>(frame.plot.bottom());
    for (std::size_t i = 0; i + 1 < chart.farBorder.size(); ++i) {
        const ImVec2 a = frame.at(chart.farBorder[i].x, chart.farBorder[i].y),
                     b = frame.at(chart.farBorder[i + 1].x, chart.farBorder[i + 1].y);
        draw.AddQuadFilled({a.x, top}, {b.x, top}, {b.x, std::clamp(b.y, top, bottom)},
                           {a.x, std::clamp(a.y, top, bottom)}, faded(colour::blur, 0.09));
    }
    const ImVec2 end = frame.at(chart.distance_m.low, chart.top_D);
    draw.AddLine(end, {static_cast<float>(frame.plot.right()), end.y}, rgb(0xC9D1DB, 110), p.px(1));
    draw.PopClipRect();
    chartCurve(draw, frame, chart.farBorder, faded(colour::blur, 0.9), p.px(1.4));
    chartCurve(draw, frame, chart.nearBorder, faded(colour::focus, 0.6), p.px(1.2), true);

    std::string under;
    for (const auto& object : chart.objects) {
        const bool chosen = p.state.selected == object.id;
        const ImVec2 at =
            frame.at(std::clamp(object.nearest_m, chart.distance_m.low, chart.distance_m.high), object.power_D);
        const ImVec2 far =
            frame.at(std::clamp(object.farthest_m, chart.distance_m.low, chart.distance_m.high), object.power_D);
        const ImU32 ink = lookColour(object.look);
        draw.AddLine(at, far, faded(ink, 0.7), p.px(3));
        const float radius = p.px(chosen ? 6.5 : 5);
        ImGui::SetCursorScreenPos({at.x - p.px(9), at.y - p.px(9)});
        ImGui::PushID(object.id.c_str());
        ImGui::InvisibleButton("###object", {p.px(18), p.px(18)});
        const bool held = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
        if (ImGui::IsItemActivated()) p.state.selected = object.id;
        if (hovered || held) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        dragObject(p, frame, object);
        const bool moved = ImGui::GetIO().MouseDragMaxDistanceSqr[0] > 4.0f;
        if (ImGui::IsItemDeactivated() && moved) p.requests.push_back(CommitGesture{"Set distance"});
        ImGui::PopID();
        draw.AddCircleFilled(at, radius, object.look == Look::focus ? colour::panel : ink);
        draw.AddCircle(at, radius, ink, 0, p.px(1.8));
        if (object.drives) {
            // Over the point, or under it where the plot ends.
            const float above = at.y - p.px(8) - ImGui::GetFontSize();
            const float place = above > static_cast<float>(frame.plot.y) ? above : at.y + p.px(8);
            draw.AddText({at.x - ImGui::GetFontSize() * 0.45f, place}, ink, hasIcons() ? icon::star : "*");
        }
        if (!hovered && !held) continue;
        under = object.name + "   " + formatted(object.nearest_m, Unit::metre) + "   lit at " +
                formatted(object.power_D, Unit::dioptre);
        if (object.pMin_D) under += "   P_min " + formatted(*object.pMin_D, Unit::dioptre);
    }
    if (!hovering(frame)) return;
    const ImVec2 mouse = ImGui::GetMousePos();
    if (under.empty()) {
        const double d = frame.xAt(static_cast<double>(mouse.x));
        under =
            formatted(d, Unit::metre) + "   blurred above " + formatted(1.0 / d + plan.farOffset.si(), Unit::dioptre);
    }
    chartNote(p, draw, {mouse.x + p.px(12), mouse.y - p.px(18)}, under, colour::text);
}

void drawSeam(Panel& p) {
    const auto& profile = p.view.computed.seam;
    if (!profile) {
        chartFrame(p, p.at.seam, "SEAM  light across the border", "no border near the cursor", {-20, 20}, {0.5, 1.5},
                   "mm", "");
        return;
    }
    const SeamChart chart = seamChart(*profile);
    const std::string summary = std::string(profile->depthStep ? "depth step, not blended: " : "worst ") +
                                formatted(chart.worstBefore, Unit::percent) + " \u2192 " +
                                formatted(chart.worstAfter, Unit::percent);
    const ChartFrame frame =
        chartFrame(p, p.at.seam, "SEAM  light across the border", summary, chart.across_mm, chart.light, "mm", "");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 one = frame.at(chart.across_mm.low, 1.0);
    draw.AddLine(one, {static_cast<float>(frame.plot.right()), one.y}, rgb(0xC9D1DB, 50));
    chartCurve(draw, frame, chart.leftBefore, faded(colour::fault, 0.65), p.px(1.2));
    chartCurve(draw, frame, chart.rightBefore, faded(colour::fault, 0.65), p.px(1.2), true);
    chartCurve(draw, frame, chart.leftAfter, colour::good, p.px(1.8));
    chartCurve(draw, frame, chart.rightAfter, colour::good, p.px(1.8), true);
    ImFont* small = font(Font::small);
    const double row = static_cast<double>(small->FontSize) + 3 * p.scale;
    const auto legend = [&](int line, const char* words, ImU32 ink) {
        draw.AddText(small, small->FontSize,
                     vec(frame.plot.x + 8 * p.scale, frame.plot.bottom() - (2 - line) * row - 4 * p.scale), ink, words);
    };
    legend(0, "before", faded(colour::fault, 0.8));
    legend(1, "blended: left, right dashed", colour::good);
    if (!hovering(frame)) return;
    const double mouse = static_cast<double>(ImGui::GetMousePos().x), x = frame.xAt(mouse);
    draw.AddLine(vec(mouse, frame.plot.y), vec(mouse, frame.plot.bottom()), rgb(0xffffff, 60));
    std::string words = number(x, 1) + " mm";
    const auto add = [&](const char* eye, const std::vector<ChartPoint>& before, const std::vector<ChartPoint>& after) {
        const auto a = valueAt(before, x), b = valueAt(after, x);
        if (a && b) words += std::string("   ") + eye + " " + number(*a, 3) + " \u2192 " + number(*b, 3);
    };
    add("L", chart.leftBefore, chart.leftAfter);
    add("R", chart.rightBefore, chart.rightAfter);
    chartNote(p, draw, vec(mouse + 10 * p.scale, frame.plot.y + 4 * p.scale), words, colour::text);
}

}  // namespace

void chartsRow(Panel& p) {
    if (p.at.sweep.empty()) return;
    const Plan* plan = p.plan();
    const auto empty = [&](const Rect& area, const char* title, const char* x, ChartRange range, bool logarithmic) {
        chartFrame(p, area, title, p.view.computed.planError.empty() ? "no plan yet" : "no plan", range, {0, 4}, x, "D",
                   logarithmic);
    };
    beginPanel("###sweep", p.at.sweep, colour::panel, false);
    if (plan != nullptr)
        drawSweep(p, *plan);
    else
        empty(p.at.sweep, "SWEEP", "ms", {0, 16.7}, false);
    ImGui::End();
    beginPanel("###blurRange", p.at.blurRange, colour::panel, false);
    if (plan != nullptr)
        drawBlurRange(p, *plan);
    else
        empty(p.at.blurRange, "BLUR RANGE", "m", {0.1, 10}, true);
    ImGui::End();
    beginPanel("###seamChart", p.at.seam, colour::panel, false);
    drawSeam(p);
    ImGui::End();
}

}  // namespace ilf::ui
