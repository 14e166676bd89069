// Sentences that come to the operator: toasts, and the three hints of the first minute.
#include <algorithm>

#include "ui/icons.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

constexpr double kNoteStays_s = 5.0, kWarningStays_s = 9.0;

bool faded(const Toast& toast, double now) {
    if (toast.tone == Tone::error) return false;
    return now - toast.since_s > (toast.tone == Tone::note ? kNoteStays_s : kWarningStays_s);
}

ImU32 toneColour(Tone tone) {
    return tone == Tone::error ? colour::fault : tone == Tone::warning ? colour::warn : colour::good;
}

struct HintText {
    Hint hint;
    const char* words;
};
constexpr HintText kHints[] = {
    {Hint::brush, "Paint what shall look blurred: the brush (B) on the picture."},
    {Hint::distance, "Say how far it is: type it on the right, or hold D and drag on the picture."},
    {Hint::take, "TAKE (Ctrl+Enter) puts what you painted on show."},
};

}  // namespace

void toasts(Panel& p) {
    auto& list = p.state.toasts;
    std::erase_if(list, [&](const Toast& toast) { return faded(toast, p.view.time_s); });
    // Along the lower edge of the picture, over nothing that can be clicked there but the picture itself.
    const double width = std::min(620 * p.scale, p.at.canvas.w - 24 * p.scale);
    double bottom = p.at.canvas.bottom() - 12 * p.scale;
    for (std::size_t i = list.size(); i-- > 0;) {
        const float inner = static_cast<float>(width) - p.px(64);
        const ImVec2 extent = ImGui::CalcTextSize(list[i].text.c_str(), nullptr, false, inner);
        const double height = static_cast<double>(extent.y) + 20 * p.scale;
        bottom -= height;
        const Rect box{p.at.canvas.x + (p.at.canvas.w - width) / 2, bottom, width, height};
        bottom -= 8 * p.scale;
        ImGui::SetNextWindowPos(vec(box.x, box.y));
        ImGui::SetNextWindowSize(vec(box.w, box.h));
        const std::string id = "###toast" + std::to_string(i);
        ImGui::PushStyleColor(ImGuiCol_WindowBg, rgb(0x1D222A, 245));
        ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, p.px(4));
        ImGui::Begin(id.c_str(), nullptr,
                     (fixedFlags() & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_NoScrollWithMouse);
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        draw.AddRectFilled(vec(box.x, box.y), vec(box.x + 4 * p.scale, box.bottom()), toneColour(list[i].tone),
                           p.px(4));
        ImGui::SetCursorPos({p.px(16), p.px(10)});
        ImGui::PushTextWrapPos(inner + p.px(16));
        ImGui::TextUnformatted(list[i].text.c_str());
        ImGui::PopTextWrapPos();
        const float side = p.px(28);
        ImGui::SetCursorPos({static_cast<float>(box.w) - side - p.px(6), (static_cast<float>(box.h) - side) / 2});
        const bool dismissed = iconButton("###dismiss", icon::cross, "x", false, side, colour::dim);
        ImGui::End();
        ImGui::PopStyleVar();
        ImGui::PopStyleColor();
        if (dismissed) list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

void hints(Panel& p) {
    if (!p.document().scene.picture || p.state.panels.hidden || p.state.popupsOpen) return;
    const auto next = std::find_if(std::begin(kHints), std::end(kHints),
                                   [&](const HintText& hint) { return !p.state.hintsUsed.contains(hint.hint); });
    if (next == std::end(kHints)) return;
    // One at a time, in the order of the work, drawn over the header where the picture is not covered.
    const auto number = static_cast<std::size_t>(next - std::begin(kHints)) + 1;
    const std::string words = std::to_string(number) + " of 3   " + next->words;
    ImFont* small = font(Font::small);
    const ImVec2 size = small->CalcTextSizeA(small->FontSize, 8192, 0, words.c_str());
    const double width = static_cast<double>(size.x) + 46 * p.scale, height = 28 * p.scale;
    const Rect box{p.at.canvas.x + (p.at.canvas.w - width) / 2, p.at.canvas.y + 10 * p.scale, width, height};
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, p.px(14));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, rgb(0x1D222A, 240));
    ImGui::SetNextWindowPos(vec(box.x, box.y));
    ImGui::SetNextWindowSize(vec(box.w, box.h));
    ImGui::Begin("###hint", nullptr,
                 (fixedFlags() & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::GetWindowDrawList()->AddText(small, small->FontSize,
                                        vec(box.x + 14 * p.scale, box.y + (height - static_cast<double>(size.y)) / 2),
                                        colour::good, words.c_str());
    ImGui::SetCursorPos({static_cast<float>(width) - p.px(28), p.px(2)});
    if (iconButton("###gotIt", icon::cross, "x", false, p.px(24), colour::dim)) p.state.hintsUsed.insert(next->hint);
    tooltip("Do not show this hint again.");
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    // A line from the hint to what it speaks of would cross the picture; the thing itself glows instead.
    ImDrawList& over = *ImGui::GetForegroundDrawList();
    const Rect target = next->hint == Hint::brush      ? p.at.tools
                        : next->hint == Hint::distance ? (p.at.selected.empty() ? p.at.pages : p.at.selected)
                                                       : Rect{p.at.top.right() - (8 + 118 + 8 + 108 + 4) * p.scale,
                                                              2 * p.scale, 116 * p.scale, p.at.top.h - 4 * p.scale};
    over.AddRect(vec(target.x + 1, target.y + 1), vec(target.right() - 1, target.bottom() - 1),
                 ui::faded(colour::good, 0.55), p.px(4), 0, p.px(1.5));
}

}  // namespace ilf::ui
