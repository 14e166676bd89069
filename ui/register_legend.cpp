// What the colours of the registering page's picture mean, in words and figures: nobody has to tell them apart by hue
// alone.
#include <algorithm>

#include "ui/register_parts.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

ImU32 inkOf(const std::array<std::uint8_t, 3>& colour) {
    return rgb((static_cast<unsigned>(colour[0]) << 16U) | (static_cast<unsigned>(colour[1]) << 8U) | colour[2]);
}

/// A swatch and its words, `width` wide; gives how high they are.
float entry(Panel& p, ImVec2 at, const QualityColour& colour, float width) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float side = ImGui::GetTextLineHeight(), left = side + p.px(8);
    draw.AddRectFilled(at, {at.x + side, at.y + side}, inkOf(colour.rgb));
    draw.AddRect(at, {at.x + side, at.y + side}, colour::line);
    ImGui::SetCursorScreenPos({at.x + left, at.y});
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width - left);
    text(colour.words, colour::text, Font::small);
    ImGui::PopTextWrapPos();
    return std::max(side, ImGui::GetItemRectSize().y) + p.px(4);
}

void entries(Panel& p, const std::vector<QualityColour>& legend, float width, int columns) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const std::size_t rows =
        (legend.size() + static_cast<std::size_t>(columns) - 1) / static_cast<std::size_t>(columns);
    const float each = width / static_cast<float>(columns);
    float lowest = from.y;
    ImVec2 at = from;
    for (std::size_t i = 0; i < legend.size(); ++i) {
        if (i > 0 && i % rows == 0) at = {at.x + each, from.y};
        at.y += entry(p, at, legend[i], each - p.px(12));
        lowest = std::max(lowest, at.y);
    }
    ImGui::SetCursorScreenPos({from.x, lowest});
}

/// A depth picture's colours between its two figures.
void ramp(Panel& p, const RegisterView& r, float width) {
    if (!r.found || !r.found->depth || r.ramp.empty()) return;
    const RegisterDepth& depth = *r.found->depth;
    const bool spread = r.shows == RegisterPicture::spread;
    const auto words = [](Metre length, Unit unit) { return formatted(length.si(), unit); };
    const std::string least = spread ? words(depth.surest, Unit::millimetre) : words(depth.nearest, Unit::metre);
    const std::string most = spread ? words(depth.vaguest, Unit::millimetre) : words(depth.farthest, Unit::metre);
    const float left = ImGui::GetCursorScreenPos().x;
    text(least, colour::text, Font::small);
    ImGui::SameLine();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetTextLineHeight(), step = std::min(p.px(8), width / 60);
    float x = from.x;
    for (const auto& colour : r.ramp) {
        draw.AddRectFilled({x, from.y}, {x + step, from.y + height}, inkOf(colour));
        x += step;
    }
    ImGui::Dummy({x - from.x, height});
    ImGui::SameLine();
    text(most, colour::text, Font::small);
    ImGui::SetCursorScreenPos({left, ImGui::GetCursorScreenPos().y});
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    text(spread ? "One standard deviation (1 sigma) of each pixel's depth; grey has none. Point at a place to read it."
                : "Depth along the camera's axis; grey has none. Point at a place to read it.",
         colour::dim, Font::small);
    ImGui::PopTextWrapPos();
}

}  // namespace

void registerLegend(Panel& p, const RegisterView& r, float width, int columns) {
    if (r.shows == RegisterPicture::quality) entries(p, r.legend, width, columns);
    if (r.shows == RegisterPicture::depth || r.shows == RegisterPicture::spread) ramp(p, r, width);
}

}  // namespace ilf::ui
