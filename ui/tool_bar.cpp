// Tools on the left, with the size, hardness and opacity of the brush in hand.
#include <array>
#include <cmath>

#include "ui/icons.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

struct ToolButton {
    Tool tool;
    Command command;
    const char* id;
};
constexpr std::array<ToolButton, 9> tools{{{Tool::move, Command::toolMove, "###move"},
                                           {Tool::brush, Command::toolBrush, "###brush"},
                                           {Tool::erase, Command::toolErase, "###erase"},
                                           {Tool::rectangle, Command::toolRectangle, "###rectangle"},
                                           {Tool::ellipse, Command::toolEllipse, "###ellipse"},
                                           {Tool::polygon, Command::toolPolygon, "###polygon"},
                                           {Tool::lasso, Command::toolLasso, "###lasso"},
                                           {Tool::select, Command::toolSelect, "###select"},
                                           {Tool::flood, Command::toolFlood, "###flood"}}};

/// Line drawings, so that shapes look like what they draw and need no font.
void drawTool(ImDrawList& draw, Tool tool, ImVec2 c, float r, ImU32 ink, float width) {
    const auto glyph = [&](const char* sign, const char* letter) {
        const char* shown = hasIcons() ? sign : letter;
        const ImVec2 size = ImGui::CalcTextSize(shown);
        draw.AddText({c.x - size.x / 2, c.y - size.y / 2}, ink, shown);
    };
    switch (tool) {
    case Tool::move:
        return glyph(icon::pointer, "V");
    case Tool::brush:
        return glyph(icon::brush, "B");
    case Tool::erase:
        return glyph(icon::eraser, "E");
    case Tool::flood:
        return glyph(icon::magic, "W");
    case Tool::select:
        return glyph(icon::objects, "S");
    case Tool::rectangle:
        draw.AddRect({c.x - r, c.y - r * 0.75f}, {c.x + r, c.y + r * 0.75f}, ink, 0, 0, width);
        return;
    case Tool::ellipse:
        for (int i = 0; i < 32; ++i) {
            const float t = 6.2831853f * static_cast<float>(i) / 32.0f;
            draw.PathLineTo({c.x + r * std::cos(t), c.y + r * 0.75f * std::sin(t)});
        }
        return draw.PathStroke(ink, ImDrawFlags_Closed, width);
    case Tool::polygon: {
        const std::array<ImVec2, 5> corners{{{c.x - r, c.y - r * 0.1f},
                                             {c.x - r * 0.1f, c.y - r},
                                             {c.x + r, c.y - r * 0.35f},
                                             {c.x + r * 0.55f, c.y + r * 0.9f},
                                             {c.x - r * 0.6f, c.y + r * 0.8f}}};
        draw.AddPolyline(corners.data(), 5, ink, ImDrawFlags_Closed, width);
        for (const ImVec2& corner : corners)
            draw.AddCircleFilled(corner, width * 1.3f, ink, 8);
        return;
    }
    case Tool::lasso:
        draw.PathLineTo({c.x - r * 0.3f, c.y + r});
        draw.PathBezierCubicCurveTo({c.x - r * 0.9f, c.y + r * 0.4f}, {c.x + r * 0.2f, c.y + r * 0.3f},
                                    {c.x - r * 0.5f, c.y + r * 0.35f}, 12);
        draw.PathBezierCubicCurveTo({c.x - r * 1.5f, c.y}, {c.x - r, c.y - r * 0.95f}, {c.x, c.y - r * 0.95f}, 16);
        draw.PathBezierCubicCurveTo({c.x + r * 1.4f, c.y - r * 0.95f}, {c.x + r * 1.3f, c.y + r * 0.5f},
                                    {c.x - r * 0.2f, c.y + r * 0.4f}, 16);
        return draw.PathStroke(ink, 0, width);
    }
}

/// A vertical slider that fills from below; a brush number at a glance, typed with its unit by a click on the number.
void brushNumber(Panel& p, const char* id, const char* name, double& value, const FieldSpec& spec) {
    const float width = static_cast<float>(p.at.tools.w) - p.px(8);
    ImGui::SetCursorPosX(p.px(4));
    ImFont* small = font(Font::small);
    const ImVec2 extent = small->CalcTextSizeA(small->FontSize, 99, 0, name);
    ImGui::SetCursorPosX((static_cast<float>(p.at.tools.w) - extent.x) / 2);
    text(name, colour::dim, Font::small);
    ImGui::SetCursorPosX(p.px(4));
    ImGui::PushFont(small);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(p.px(4), p.px(3)));
    if (const auto change = numberField(p, id, value, spec, width)) value = change->value;
    ImGui::PopStyleVar();
    ImGui::PopFont();
}

}  // namespace

void toolBar(Panel& p) {
    beginPanel("###tools", p.at.tools, colour::panel, false);
    const float side = p.px(p.at.tools.h > 520 * p.scale ? 36 : 30);
    const float left = (static_cast<float>(p.at.tools.w) - side) / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, p.px(1)));
    ImGui::SetCursorPosY(p.px(6));
    for (const ToolButton& button : tools) {
        ImGui::SetCursorPosX(left);
        const ImVec2 from = ImGui::GetCursorScreenPos();
        const bool on = p.state.tool == button.tool;
        if (ImGui::InvisibleButton(button.id, {side, side})) p.run(button.command);
        commandTooltip(button.command);
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        const ImVec2 to{from.x + side, from.y + side};
        if (on) draw.AddRectFilled(from, to, rgb(0x333D4B), p.px(4));
        if (!on && ImGui::IsItemHovered()) draw.AddRectFilled(from, to, rgb(0xffffff, 14), p.px(4));
        drawTool(draw, button.tool, {from.x + side / 2, from.y + side / 2}, side * 0.24f,
                 on ? rgb(0xffffff) : colour::neutral, p.px(1.5));
    }
    ImGui::Dummy({1, p.px(4)});
    const bool erasing = p.state.tool == Tool::erase;
    if (erasing || p.state.tool == Tool::brush) {
        ImGui::PushID(erasing ? "eraser" : "brush");
        Brush& brush = erasing ? p.state.eraser : p.state.brush;
        brushNumber(p, "###size", "size", brush.radius,
                    {Unit::pixel, 0.5, 1000.0, 0.0, "Radius in picture pixels ([ and ])."});
        brushNumber(
            p, "###hardness", "hard", brush.hardness,
            {Unit::percent, 0.0, 1.0, 0.005, "Share of the radius that is fully covered (Shift+[ and Shift+])."});
        brushNumber(p, "###opacity", "opacity", brush.opacity,
                    {Unit::percent, 0.01, 1.0, 0.005, "How much a dab covers."});
        ImGui::PopID();
    } else if (p.state.tool == Tool::flood) {
        ImGui::SetCursorPosX(left);
        if (iconButton("###byDepth", icon::cube, "Z", p.state.floodByDepth, side,
                       p.state.floodByDepth ? colour::derived : colour::dim)) {
            p.run(Command::floodByDepth);
        }
        commandTooltip(Command::floodByDepth);
    }
    if (p.state.tool == Tool::flood && p.state.floodByDepth) {
        brushNumber(
            p, "###surfaceTolerance", "bend", p.state.surfaceTolerance,
            {Unit::number, 0.1, 10.0, 0.05, "How much a surface may bend, times what the depth map's noise allows."});
    } else if (p.state.tool == Tool::flood) {
        brushNumber(p, "###tolerance", "range", p.state.floodTolerance,
                    {Unit::percent, 0.0, 1.0, 0.002, "How far a colour may differ and still be taken."});
    }
    ImGui::Dummy({1, p.px(4)});
    ImGui::SetCursorPosX(left);
    if (iconButton("###protect", icon::shield, "K", p.state.protectOthers, side,
                   p.state.protectOthers ? colour::good : colour::dim)) {
        p.run(Command::protectOthers);
    }
    commandTooltip(Command::protectOthers);
    ImGui::PopStyleVar();
    ImGui::End();
}

}  // namespace ilf::ui
