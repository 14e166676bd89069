// Says that the camera was bumped, and what one click can do about it.
#include <algorithm>

#include "core/base/as_text.h"
#include "ui/register_page.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

bool offered(Panel& p, const char* words, const char* help) {
    const bool pressed = ImGui::Button(words, {0, p.px(34)});
    tooltip(help);
    ImGui::SameLine();
    return pressed;
}

void ask(Panel& p, Register::Step step) { p.requests.push_back(Register{step}); }

}  // namespace

void bumpBanner(Panel& p) {
    if (!p.view.bump) return;
    const float width = std::min(p.px(620), static_cast<float>(p.at.canvas.w) - p.px(24));
    ImGui::SetNextWindowPos(vec(p.at.canvas.x + (p.at.canvas.w - width) / 2.0, p.at.canvas.y + 12 * p.scale));
    ImGui::SetNextWindowSize({width, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, rgb(0x1D222A, 245));
    ImGui::Begin("###bump", nullptr,
                 (fixedFlags() & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    wrapped("The camera was moved since it was registered: what it sees lies " + asText("%.1f", p.view.bump->moved_px) +
                " pixels beside where regions were painted.",
            colour::warn);
    if (offered(p, "Register again###bumpAgain", "Opens the page of the registration.")) ask(p, Register::Step::open);
    if (offered(p, "Move along###bumpShift",
                "The camera's picture, regions and map move by what is seen; a scan is more exact. Undo brings back."))
        ask(p, Register::Step::shift);
    if (offered(p, "Later###bumpQuiet", "Not said again until the camera is registered anew."))
        ask(p, Register::Step::quiet);
    ImGui::End();
    ImGui::PopStyleColor();
}

}  // namespace ilf::ui
