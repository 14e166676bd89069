// Pages below the list: region (in low windows), rig, history; the tabs of all.
#include <array>
#include <cmath>

#include "ui/icons.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

struct Tab {
    Page page;
    const char* name;
};
constexpr std::array<Tab, 7> tabs{{{Page::selected, "Region###region"},
                                   {Page::wearer, "Wearer###wearer"},
                                   {Page::seam, "Seam###seam"},
                                   {Page::light, "Light###light"},
                                   {Page::rig, "Rig###rig"},
                                   {Page::scene, "Scene###scene"},
                                   {Page::history, "History###history"}}};

}  // namespace

void rigPage(Panel& p) {
    const Rig& rig = p.document().rig;
    text(rig.name, colour::text, Font::strong);
    ImGui::SameLine();
    text(rig.provenance, rig.provenance == "measured" ? colour::good : colour::warn);
    const auto rate = [&](const char* label, const char* id, double value, FieldSpec spec, auto put) {
        if (const auto change = numberRow(p, label, id, value, spec)) {
            Rig next = rig;
            put(next, change->value);
            p.edit(change->commits, SetRig{next});
        }
    };
    derivedRow(p, "Projector",
               std::to_string(rig.projector.width) + " \u00d7 " + std::to_string(rig.projector.height) + " px");
    rate("Sweep", "###sweepRate", rig.sweepRate.si(),
         {Unit::hertz, 30.0, 240.0, 0.5, "Sweeps per second; below 60 Hz light in slots flickers."},
         [](Rig& r, double v) { r.sweepRate = Hertz::fromSi(v); });
    rate("Slots", "###slotRate", rig.slotRate.si(),
         {Unit::hertz, 60.0, 10000.0, 5.0, "Slots per second: a whole multiple of the sweep rate."},
         [](Rig& r, double v) { r.slotRate = Hertz::fromSi(v); });
    rate("Delay", "###delay", rig.projectorDelay.si(), {Unit::millisecond, 0.0, 0.05, 1e-5, "From trigger to light."},
         [](Rig& r, double v) { r.projectorDelay = Second::fromSi(v); });
    rate("Lens from", "###lensMin", rig.lensMin.si(), {Unit::dioptre, -30.0, 0.0, 0.02, "Least power of the lens."},
         [](Rig& r, double v) { r.lensMin = Dioptre::fromSi(v); });
    rate("Lens to", "###lensMax", rig.lensMax.si(), {Unit::dioptre, 0.0, 30.0, 0.02, "Largest power of the lens."},
         [](Rig& r, double v) { r.lensMax = Dioptre::fromSi(v); });
    primariesRows(p);
    const CoreStatus& core = p.view.core;
    ImGui::Dummy({1, p.px(4)});
    heading("OUTPUT CORE");
    if (!core.connected) {
        wrapped("Not connected: what the room shows is not known here. The studio keeps trying.", colour::fault);
        return;
    }
    derivedRow(p, "Projector", core.projector);
    derivedRow(p, "Lens", core.lens);
    derivedRow(p, "Light",
               core.light == Light::steady    ? "steady white"
               : core.light == Light::slotted ? "plays a program"
                                              : "unknown");
    derivedRow(p, "Revision",
               std::to_string(core.revisionPlayed) + " played, " + std::to_string(core.revisionSent) + " sent");
    derivedRow(p, "Swaps", std::to_string(core.swaps) + ", " + std::to_string(core.droppedUpdates) + " dropped");
    derivedRow(p, "To light", formatted(core.strokeToSwap_ms * 1e-3, Unit::millisecond), "From a stroke to its swap.");
    if (!core.lastFault.empty()) wrapped("Last fault: " + core.lastFault, core.faultSeen ? colour::dim : colour::fault);
}

void historyPage(Panel& p) {
    const auto& labels = p.view.historyLabels;
    for (std::size_t i = labels.size(); i-- > 0;) {
        ImGui::PushID(static_cast<int>(i));
        const bool undone = i > p.view.historyPosition;
        ImGui::PushStyleColor(ImGuiCol_Text, undone ? colour::dim : colour::text);
        const std::string name = (labels[i].empty() ? std::string("Opened") : labels[i]) + "###step";
        if (ImGui::Selectable(name.c_str(), i == p.view.historyPosition)) p.requests.push_back(GoToHistory{i});
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
}

void pagesPanel(Panel& p) {
    beginPanel("###pages", p.at.pages, colour::panel, true, false);
    const bool own = !p.at.selected.empty();
    Page shown = p.state.page;
    if (own && shown == Page::selected) shown = Page::wearer;
    // Typing a distance by key brings the field into view.
    if (!own && p.state.focusDistance) p.state.page = shown = Page::selected;

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::size_t first = own ? 1 : 0;
    const float width = ImGui::GetContentRegionAvail().x, each = width / static_cast<float>(tabs.size() - first);
    const float height = ImGui::GetFrameHeight();
    const ImVec2 start = ImGui::GetCursorScreenPos();
    ImGui::PushFont(font(Font::small));
    for (std::size_t i = first; i < tabs.size(); ++i) {
        ImGui::SetCursorScreenPos({start.x + each * static_cast<float>(i - first), start.y});
        if (ImGui::InvisibleButton(tabs[i].name, {each, height})) p.state.page = tabs[i].page;
        const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
        const bool on = tabs[i].page == shown;
        const char* end = std::char_traits<char>::find(tabs[i].name, 12, '#');
        const ImVec2 size = ImGui::CalcTextSize(tabs[i].name, end);
        draw.AddText({a.x + (each - size.x) / 2, a.y + (height - size.y) / 2},
                     on                       ? colour::text
                     : ImGui::IsItemHovered() ? colour::neutral
                                              : colour::dim,
                     tabs[i].name, end);
        draw.AddRectFilled({a.x + p.px(4), b.y - p.px(2)}, {b.x - p.px(4), b.y}, on ? colour::text : colour::line);
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos({start.x, start.y + height + p.px(8)});
    // The tabs stay where they are; the page below them scrolls, each by its own amount.
    ImGui::BeginChild(static_cast<ImGuiID>(1 + static_cast<int>(shown)), {0, 0}, false,
                      fixedFlags() & ~ImGuiWindowFlags_NoScrollbar);
    switch (shown) {
    case Page::selected:
        selectedPage(p);
        break;
    case Page::wearer:
        wearerPage(p);
        break;
    case Page::seam:
        seamPage(p);
        break;
    case Page::light:
        lightPage(p);
        break;
    case Page::rig:
        rigPage(p);
        break;
    case Page::scene:
        scenePage(p);
        break;
    case Page::history:
        historyPage(p);
        break;
    }
    ImGui::EndChild();
    ImGui::End();
}

}  // namespace ilf::ui
