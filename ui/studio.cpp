#include "ui/studio.h"

#include <algorithm>
#include <cmath>

#include "ui/measure_page.h"
#include "ui/panel.h"
#include "ui/register_page.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

/// Thin invisible handles over the borders between panels.
void splitter(const char* id, const Rect& at, bool vertical, double& size, double perPixel) {
    if (at.empty()) return;
    ImGui::SetNextWindowPos(vec(at.x, at.y));
    ImGui::SetNextWindowSize(vec(at.w, at.h));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::Begin(id, nullptr, fixedFlags() | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::InvisibleButton("###grip", vec(at.w, at.h));
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        ImGui::GetWindowDrawList()->AddRectFilled(
            vec(at.x + (vertical ? at.w / 2 - 1 : 0), at.y + (vertical ? 0 : at.h / 2 - 1)),
            vec(at.x + (vertical ? at.w / 2 + 1 : at.w), at.y + (vertical ? at.h : at.h / 2 + 1)), rgb(0x5A6779));
    }
    if (ImGui::IsItemActive()) {
        const ImVec2 moved = ImGui::GetIO().MouseDelta;
        size += static_cast<double>(vertical ? moved.x : moved.y) * perPixel;
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

/// The selection follows the document: a region that is gone can not stay selected.
void reselect(State& state, const Document& document) {
    if (findRegion(document, state.selected) != nullptr) return;
    // A region asked for in the last frame arrives in this one; until then nothing else takes its place.
    state.selected = document.regions.empty() ? kBackgroundId : document.regions.front()->id;
}

}  // namespace

void splitters(Panel& p) {
    PanelSizes& sizes = p.state.panels;
    if (sizes.hidden) return;
    splitter("###sideSplitter", p.at.sideSplitter, true, sizes.side, -1.0 / p.scale);
    splitter("###chartSplitter", p.at.chartSplitter, false, sizes.charts, -1.0 / p.scale);
    const double column = p.at.regions.h + p.at.selected.h + p.at.pages.h;
    splitter("###regionsSplitter", p.at.regionsSplitter, false, sizes.regions, column > 0 ? 1.0 / column : 0.0);
    sizes.side = std::clamp(sizes.side, 240.0, 900.0);
    sizes.charts = std::clamp(sizes.charts, 100.0, 700.0);
    sizes.regions = std::clamp(sizes.regions, 0.15, 0.6);
}

Requests studio(const View& view, State& state, const Input& input) {
    Requests requests;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const Size window{static_cast<int>(display.x), static_cast<int>(display.y)};
    const double scale = view.scale > 0.0 ? view.scale : 1.0;
    reselect(state, view.document);
    const bool onePage = view.registering.has_value();
    Panel p{view, state, input, requests, layout(window, scale, state.panels, onePage), scale};
    for (const std::string& path : input.dropped)
        requests.push_back(OpenFile{path, false});
    shortcutKeys(p);
    p.at = layout(window, scale, state.panels, onePage);

    topBar(p);
    const bool page = view.measuring || view.registering;  // in the picture's place
    if (view.measuring)
        measurePage(p);
    else if (view.registering)
        registerPage(p);
    else
        canvas(p);
    if (!state.panels.hidden) {
        if (!onePage) toolBar(p);
        if (!page) canvasHeader(p);
        regionsPanel(p);
        selectedPanel(p);
        pagesPanel(p);
        if (!page) chartsRow(p);
        statusLine(p);
        splitters(p);
    }
    if (!page) bumpBanner(p);
    debugPanel(p);
    if (!page) hints(p);  // they are about the picture
    toasts(p);
    dialogs(p);
    return requests;
}

Wants wants(const State& state) {
    Wants wanted;
    const bool compare = state.mode == ViewMode::compare;
    const bool perceived = compare || state.mode == ViewMode::perceived;
    wanted.perceivedLeft = perceived && state.eye == Eye::left;
    wanted.perceivedRight = perceived && state.eye == Eye::right;
    wanted.plain = compare || state.plainHeld;
    wanted.lights = state.mode == ViewMode::light;
    wanted.slot = state.slot;
    wanted.cursor = state.cursor;
    wanted.zoom = state.zoom;
    wanted.selected = state.selected;
    wanted.seeing = state.seeing;
    wanted.gesture = state.gesture.kind != CanvasGesture::Kind::none || state.field.scrubbing != 0;
    return wanted;
}

}  // namespace ilf::ui
