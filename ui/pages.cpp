// Pages below the list: region (in low windows), history; the tabs of all.
#include <array>

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
