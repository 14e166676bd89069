#include "ui/widgets.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace ilf::ui {

ImGuiWindowFlags fixedFlags() {
    // Tab jumps from field to field only while one is being typed in; otherwise it hides the panels.
    return ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
           ImGuiWindowFlags_NoBringToFrontOnFocus |
           (ImGui::GetIO().WantTextInput ? 0 : static_cast<int>(ImGuiWindowFlags_NoNavInputs));
}

bool beginPanel(const char* id, const Rect& rect, ImU32 ground, bool padded, bool scrolls) {
    ImGui::SetNextWindowPos(vec(rect.x, rect.y));
    ImGui::SetNextWindowSize(vec(std::max(1.0, rect.w), std::max(1.0, rect.h)));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ground);
    if (!padded) ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGuiWindowFlags flags = fixedFlags();
    if (scrolls) flags &= ~ImGuiWindowFlags_NoScrollbar;
    if (!scrolls) flags |= ImGuiWindowFlags_NoScrollWithMouse;
    const bool visible = ImGui::Begin(id, nullptr, flags);
    if (!padded) ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    return visible;
}

void text(const std::string& words, ImU32 ink, Font which) {
    ImGui::PushFont(font(which));
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::TextUnformatted(words.data(), words.data() + words.size());
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

void wrapped(const std::string& words, ImU32 ink, Font which) {
    ImGui::PushTextWrapPos(0.0f);
    text(words, ink, which);
    ImGui::PopTextWrapPos();
}

void tooltip(const std::string& words) {
    if (words.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 22.0f);
    ImGui::TextUnformatted(words.data(), words.data() + words.size());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void commandTooltip(Command command, const std::string& reason) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    const CommandInfo& about = info(command);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 22.0f);
    text(about.title, colour::text, Font::strong);
    if (const std::string key = keyText(about.key); !key.empty()) {
        ImGui::SameLine();
        text(key, colour::dim);
    }
    text(about.help);
    if (!reason.empty()) text(reason, colour::warn);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void heading(const std::string& words) { text(words, colour::dim, Font::small); }

bool iconButton(const char* id, const char* icon, const char* word, bool on, float side, ImU32 ink) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(id, {side, side});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + side, from.y + side};
    const float rounding = ImGui::GetStyle().FrameRounding;
    if (on) draw.AddRectFilled(from, to, rgb(0x2F3947), rounding);
    if (hovered) draw.AddRectFilled(from, to, rgb(0xffffff, 14), rounding);
    const char* label = hasIcons() ? icon : word;
    const ImVec2 size = ImGui::CalcTextSize(label);
    const float alpha = ImGui::GetStyle().Alpha;
    draw.AddText({from.x + (side - size.x) / 2, from.y + (side - size.y) / 2}, faded(ink, static_cast<double>(alpha)),
                 label);
    return pressed;
}

bool chip(const char* id, const std::string& words, ImU32 dot, const std::string& more) {
    const float height = ImGui::GetFrameHeight(), pad = ImGui::GetStyle().FramePadding.x;
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float radius = height * 0.15f;
    const bool pressed = ImGui::InvisibleButton(id, {size.x + pad * 3 + radius * 2, height});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 to = ImGui::GetItemRectMax();
    draw.AddRectFilled(from, to, ImGui::IsItemHovered() ? rgb(0x2A313B) : rgb(0x1D222A), height / 2);
    draw.AddCircleFilled({from.x + pad + radius, from.y + height / 2}, radius, dot);
    draw.AddText({from.x + pad * 2 + radius * 2, from.y + (height - size.y) / 2}, colour::text, words.c_str());
    tooltip(more);
    return pressed;
}

std::optional<int> choice(const char* id, std::initializer_list<const char*> names, int current, float width) {
    std::optional<int> chosen;
    ImGui::PushID(id);
    const float height = ImGui::GetFrameHeight();
    const float each = width / static_cast<float>(names.size());
    const ImVec2 start = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float rounding = ImGui::GetStyle().FrameRounding;
    draw.AddRectFilled(start, {start.x + width, start.y + height}, rgb(0x0C0F12), rounding);
    int index = 0;
    for (const char* name : names) {
        const ImVec2 from{start.x + each * static_cast<float>(index), start.y};
        ImGui::SetCursorScreenPos(from);
        if (ImGui::InvisibleButton(name, {each, height})) chosen = index;
        const ImVec2 to{from.x + each, from.y + height};
        const bool on = index == current;
        if (on) draw.AddRectFilled(from, to, rgb(0x333D4B), rounding);
        if (!on && ImGui::IsItemHovered()) draw.AddRectFilled(from, to, rgb(0xffffff, 14), rounding);
        const char* shown = name;
        const char* end = ImGui::FindRenderedTextEnd(name);
        const ImVec2 size = ImGui::CalcTextSize(shown, end);
        draw.AddText({from.x + (each - size.x) / 2, from.y + (height - size.y) / 2}, on ? colour::text : colour::dim,
                     shown, end);
        ++index;
    }
    ImGui::PopID();
    return chosen;
}

void lookSwatch(ImDrawList& draw, ImVec2 from, ImVec2 to, Look look, float scale) {
    const ImU32 ink = lookColour(look);
    draw.AddRectFilled(from, to, faded(ink, 0.16), 2 * scale);
    if (look == Look::blur) {
        draw.PushClipRect(from, to, true);
        for (float x = from.x - (to.y - from.y); x < to.x; x += 5 * scale) {
            draw.AddLine({x, to.y}, {x + (to.y - from.y), from.y}, ink, 1.4f * scale);
        }
        draw.PopClipRect();
    }
    if (look == Look::focus) {
        const float step = 4 * scale;
        for (float x = from.x; x <= to.x; x += step) {
            draw.AddCircleFilled({x, from.y}, 1.1f * scale, ink, 6);
            draw.AddCircleFilled({x, to.y}, 1.1f * scale, ink, 6);
        }
        for (float y = from.y + step; y < to.y; y += step) {
            draw.AddCircleFilled({from.x, y}, 1.1f * scale, ink, 6);
            draw.AddCircleFilled({to.x, y}, 1.1f * scale, ink, 6);
        }
    } else {
        draw.AddRect(from, to, ink, 2 * scale, 0, 1.2f * scale);
    }
}

void rowLabel(Panel& p, const char* label, const char* help) {
    ImGui::AlignTextToFramePadding();
    text(label, colour::dim);
    tooltip(help);
    ImGui::SameLine(p.px(118));
}

std::optional<FieldChange> numberRow(Panel& p, const char* label, const char* id, double value, const FieldSpec& spec,
                                     bool takeFocus) {
    rowLabel(p, label, spec.help);
    return numberField(p, id, value, spec, 0.0f, takeFocus);
}

void derivedRow(Panel& p, const char* label, const std::string& value, const char* help) {
    rowLabel(p, label, help);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetStyle().FramePadding.x);
    text(value, colour::derived);
    tooltip(help);
}

}  // namespace ilf::ui
