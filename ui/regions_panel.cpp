// The list of regions: look, name, distance, what drives the sweep; order, visibility, lock, solo.
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "ui/icons.h"
#include "ui/new_region.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

std::string distanceText(const Panel& p, const Region& region) {
    if (const auto* constant = std::get_if<ConstantDistance>(&region.distance)) return formatted(constant->value);
    if (const RegionPlan* planned = p.planOf(region.id)) return formatted(planned->nearest) + "\u2026";
    return std::holds_alternative<PlaneDistance>(region.distance) ? "plane" : "depth map";
}

void renameField(Panel& p, const Region& region, float width) {
    State& state = p.state;
    ImGui::SetNextItemWidth(width);
    if (state.nameJustOpened) ImGui::SetKeyboardFocusHere();
    const bool waiting = std::exchange(state.nameJustOpened, false);
    const bool entered = ImGui::InputText("###name", &state.nameText,
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool left = ImGui::IsItemDeactivated();
    if (!entered && !left) {
        if (!waiting && !ImGui::IsItemActive() && ImGui::GetActiveID() != 0) state.renaming.clear();
        return;
    }
    const bool escaped = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (!escaped && !state.nameText.empty() && state.nameText != region.name) {
        p.commit(RenameRegion{region.id, state.nameText});
    }
    state.renaming.clear();
}

/// One row. The selectable lies beneath; icons are drawn over it and take their own clicks.
void row(Panel& p, const Region& region, bool background) {
    State& state = p.state;
    const RegionId id = region.id;
    ImGui::PushID(id.c_str());
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float height = p.px(30), width = ImGui::GetContentRegionAvail().x;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const ImVec2 to{from.x + width, from.y + height};
    const ImVec2 below = ImGui::GetCursorPos();
    const bool on = state.selected == id;

    const float iconSide = p.px(22), icons = background ? 0.0f : iconSide * 3;
    const float nameWidth = width - icons;
    if (ImGui::InvisibleButton("###row", {nameWidth, height})) state.selected = id;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        state.selected = id;
        p.run(Command::renameRegion);
    }
    if (ImGui::IsItemHovered() && !on) draw.AddRectFilled(from, to, rgb(0xffffff, 10), p.px(4));
    if (on) {
        draw.AddRectFilled(from, to, rgb(0x2A323D), p.px(4));
        draw.AddRectFilled(from, {from.x + p.px(3), to.y}, lookColour(region.look), p.px(2));
    }
    if (!background && ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoPreviewTooltip)) {
        ImGui::SetDragDropPayload("region", id.c_str(), id.size() + 1);
        ImGui::EndDragDropSource();
    }
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("region")) {
            const RegionId moved = static_cast<const char*>(payload->Data);
            const auto& regions = p.document().regions;
            int index = static_cast<int>(regions.size()) - 1;
            for (std::size_t i = 0; i < regions.size(); ++i) {
                if (regions[i]->id == id) index = static_cast<int>(i);
            }
            p.commit(MoveRegion{moved, index});
        }
        ImGui::EndDragDropTarget();
    }

    const float alpha = region.visible ? 1.0f : 0.4f;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, alpha);
    const float swatch = p.px(14), middle = (height - swatch) / 2;
    lookSwatch(draw, {from.x + p.px(10), from.y + middle}, {from.x + p.px(10) + swatch, from.y + middle + swatch},
               region.look, static_cast<float>(p.scale));
    const float nameLeft = p.px(32);
    const std::string distance = distanceText(p, region);
    const float distanceWidth = ImGui::CalcTextSize(distance.c_str()).x;
    const bool drives = p.plan() != nullptr && p.plan()->driver == id;
    const float distanceLeft = nameWidth - distanceWidth - p.px(drives ? 24 : 8);
    const float textTop = from.y + (height - ImGui::GetFontSize()) / 2;
    if (state.renaming == id) {
        ImGui::SetCursorScreenPos({from.x + nameLeft, from.y + (height - ImGui::GetFrameHeight()) / 2});
        renameField(p, region, nameWidth - nameLeft);
    } else {
        const ImVec4 clip{from.x, from.y, from.x + distanceLeft - p.px(6), to.y};
        const RegionPlan* planned = p.planOf(id);
        const bool problem = planned != nullptr && !planned->problem.empty();
        draw.AddText(nullptr, 0, {from.x + nameLeft, textTop}, ImGui::GetColorU32(ImGuiCol_Text), region.name.c_str(),
                     nullptr, 0, &clip);
        draw.AddText({from.x + distanceLeft, textTop},
                     problem ? colour::warn : ImGui::GetColorU32(ImGuiCol_TextDisabled), distance.c_str());
        if (drives) {
            draw.AddText({from.x + nameWidth - p.px(20), textTop}, lookColour(region.look),
                         hasIcons() ? icon::star : "*");
        }
    }
    ImGui::PopStyleVar();

    if (!background) {
        const float top = from.y + (height - iconSide) / 2;
        const auto toggle = [&](int place, const char* name, const char* sign, const char* word, bool lit, Edit edit,
                                const char* help) {
            ImGui::SetCursorScreenPos({to.x - iconSide * static_cast<float>(3 - place), top});
            // Settings at rest are quiet: a row reads as name and distance.
            if (iconButton(name, sign, word, false, iconSide, lit ? colour::text : rgb(0x4A5462)))
                p.commit(std::move(edit));
            tooltip(help);
        };
        ImGui::PushFont(font(Font::small));
        toggle(0, "###visible", region.visible ? icon::eye : icon::eyeOff, region.visible ? "o" : "-", !region.visible,
               SetVisible{id, !region.visible}, "Visible: takes part in light and plan (H).");
        toggle(1, "###locked", region.locked ? icon::lock : icon::unlock, region.locked ? "#" : ".", region.locked,
               SetLocked{id, !region.locked}, "Locked: can not be painted.");
        toggle(2, "###solo", region.solo ? icon::solo : icon::soloOff, region.solo ? "S" : "s", region.solo,
               SetSolo{id, !region.solo}, "Solo: only soloed regions take part.");
        ImGui::PopFont();
    }
    ImGui::SetCursorPos({below.x, below.y + height + p.px(1)});
    ImGui::PopID();
}

}  // namespace

void regionsPanel(Panel& p) {
    beginPanel("###regions", p.at.regions);
    const float side = ImGui::GetFrameHeight(), width = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    heading("REGIONS");
    const float left = ImGui::GetCursorStartPos().x + width;
    const auto button = [&](int fromRight, Command command, const char* id, const char* sign, const char* word) {
        ImGui::SameLine(left - side * static_cast<float>(fromRight));
        const std::string reason = whyNot(command, p.view, p.state);
        if (iconButton(id, sign, word, false, side, reason.empty() ? colour::text : rgb(0x4A5462))) p.run(command);
        commandTooltip(command, reason);
    };
    button(5, Command::regionUp, "###up", icon::up, "^");
    button(4, Command::regionDown, "###down", icon::down, "v");
    button(3, Command::duplicateRegion, "###duplicate", icon::clone, "D");
    button(2, Command::addRegion, "###add", icon::plus, "+");
    button(1, Command::deleteRegion, "###delete", icon::minus, "-");

    ImGui::BeginChild("###list", {0, 0}, false, ImGui::GetIO().WantTextInput ? 0 : ImGuiWindowFlags_NoNavInputs);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(p.px(8), 0));
    for (const Box<Region>& region : p.document().regions)
        row(p, *region, false);
    if (p.document().background) row(p, *p.document().background, true);
    ImGui::PopStyleVar();
    if (p.document().regions.empty()) {
        wrapped("Nothing is painted yet. Take the brush (B) and paint what shall look blurred.", colour::dim,
                Font::small);
    }
    ImGui::EndChild();
    ImGui::End();
}

}  // namespace ilf::ui
