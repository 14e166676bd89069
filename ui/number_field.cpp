// A number with its unit: click to type, drag to scrub.
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "ui/widgets.h"

namespace ilf::ui {

namespace {

/// The field as text being typed. Gives a change when the text is left with something that can be used.
std::optional<FieldChange> typed(Panel& p, unsigned id, const char* name, double value, const FieldSpec& spec,
                                 float width) {
    FieldState& field = p.state.field;
    ImGui::SetNextItemWidth(width);
    if (field.justOpened) ImGui::SetKeyboardFocusHere();
    // An id of its own: the button it replaces may still be held down by the key that opened it.
    ImGui::PushID("typed");
    const bool entered =
        ImGui::InputText(name, &field.text, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopID();
    const bool left = ImGui::IsItemDeactivated();
    // The focus asked for arrives a frame later.
    const bool waiting = std::exchange(field.justOpened, false);
    if (!entered && !left) {
        if (!waiting && !ImGui::IsItemActive() && ImGui::GetActiveID() != 0) field.editing = 0;
        return std::nullopt;
    }
    field.editing = 0;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) || field.text == formatted(value, spec.unit)) {
        field.refused = 0;
        return std::nullopt;
    }
    const Result<double> read = parsedWithin(field.text, spec.unit, spec.low, spec.high);
    if (!read) {
        field.refused = id;
        field.refusal = read.error().what;
        return std::nullopt;
    }
    field.refused = 0;
    return FieldChange{*read, true};
}

void drawn(unsigned, double value, const FieldSpec& spec, float width, bool hovered, bool active) {
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const ImGuiCol ground = active ? ImGuiCol_FrameBgActive : hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(from, to, ImGui::GetColorU32(ground), ImGui::GetStyle().FrameRounding);
    const std::string shown = formatted(value, spec.unit);
    // The unit is quieter than the number.
    const auto unitAt = shown.find_first_not_of("0123456789.-");
    const auto split = unitAt == std::string::npos ? shown.size() : unitAt;
    const float x = from.x + ImGui::GetStyle().FramePadding.x, y = from.y + ImGui::GetStyle().FramePadding.y;
    const ImVec4 clip{from.x, from.y, from.x + width, to.y};
    const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text), quiet = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    draw.AddText(nullptr, 0, {x, y}, ink, shown.data(), shown.data() + split, 0, &clip);
    const float numberWidth = ImGui::CalcTextSize(shown.data(), shown.data() + split).x;
    draw.AddText(nullptr, 0, {x + numberWidth, y}, quiet, shown.data() + split, nullptr, 0, &clip);
}

}  // namespace

std::optional<FieldChange> numberField(Panel& p, const char* name, double value, const FieldSpec& spec, float width,
                                       bool takeFocus) {
    FieldState& field = p.state.field;
    const unsigned id = ImGui::GetID(name);
    if (width <= 0.0f) width = std::max(p.px(60), ImGui::GetContentRegionAvail().x);
    std::optional<FieldChange> change;

    const auto open = [&] {
        field.editing = id;
        field.justOpened = true;
        field.text = formatted(value, spec.unit);
        field.refused = 0;
    };
    if (takeFocus) open();
    if (field.editing == id) {
        change = typed(p, id, name, value, spec, width);
    } else {
        const bool clicked = ImGui::InvisibleButton(name, {width, ImGui::GetFrameHeight()});
        const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
        if (hovered || active) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        const bool dragged = active && ImGui::IsMouseDragging(ImGuiMouseButton_Left, p.px(3));
        if (dragged && field.scrubbing != id) {
            field.scrubbing = id;
            field.scrubbed = value;
            field.refused = 0;
        }
        if (field.scrubbing == id) {
            const auto moved =
                static_cast<double>(ImGui::GetIO().MouseDelta.x) / p.scale * (ImGui::GetIO().KeyShift ? 0.1 : 1.0);
            field.scrubbed =
                spec.perPixel > 0.0 ? field.scrubbed + moved * spec.perPixel : field.scrubbed * std::exp(moved * 0.005);
            field.scrubbed = std::clamp(field.scrubbed, spec.low, spec.high);
            if (!active) {
                field.scrubbing = 0;
                change = FieldChange{field.scrubbed, true};
            } else if (moved != 0.0) {
                change = FieldChange{field.scrubbed, false};
            }
        } else if (clicked) {
            open();
        }
        drawn(id, field.scrubbing == id ? field.scrubbed : value, spec, width, hovered, active);
        if (!active) tooltip(spec.help);
    }
    if (field.refused == id) wrapped(field.refusal, colour::fault, Font::small);
    return change;
}

}  // namespace ilf::ui
