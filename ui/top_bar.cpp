// The menu, the chips of the devices, TAKE and SAFE LIGHT.
#include <array>
#include <string_view>

#include "ui/devices_card.h"
#include "ui/icons.h"
#include "ui/new_region.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

bool checked(Command command, const Panel& p) {
    const Region* region = p.selected();
    switch (command) {
    case Command::protectOthers:
        return p.state.protectOthers;
    case Command::hideRegion:
        return region != nullptr && !region->visible;
    case Command::lockRegion:
        return region != nullptr && region->locked;
    case Command::soloRegion:
        return region != nullptr && region->solo;
    case Command::toggleLive:
        return p.view.camera.live;
    case Command::lockCamera:
        return p.view.camera.locked;
    case Command::liveTake:
        return p.view.liveTake;
    case Command::viewScene:
        return p.state.mode == ViewMode::scene;
    case Command::viewPerceived:
        return p.state.mode == ViewMode::perceived;
    case Command::viewLight:
        return p.state.mode == ViewMode::light;
    case Command::viewCompare:
        return p.state.mode == ViewMode::compare;
    case Command::holdPlain:
        return p.state.plainHeld;
    case Command::hideOverlay:
        return p.state.overlayHidden;
    case Command::hidePanels:
        return p.state.panels.hidden;
    case Command::seamMarks:
        return p.state.seamMarks;
    case Command::debugPanel:
        return p.state.debugOpen;
    default:
        return false;
    }
}

void recentFiles(Panel& p) {
    if (p.view.recent.empty() || !ImGui::BeginMenu("Open recent###recent")) return;
    int index = 0;
    for (const RecentFile& file : p.view.recent) {
        ImGui::PushID(index++);
        if (ImGui::MenuItem((file.name + "###file").c_str())) p.requests.push_back(OpenFile{file.path, false});
        tooltip(file.path);
        ImGui::PopID();
    }
    ImGui::EndMenu();
}

void menus(Panel& p) {
    for (const char* menu : {"File", "Edit", "View", "Scene", "Rig", "Show", "Help"}) {
        if (!ImGui::BeginMenu(menu)) continue;
        for (const CommandInfo& entry : commands()) {
            if (std::string_view(entry.menu) != menu) continue;
            const std::string reason = whyNot(entry.command, p.view, p.state);
            std::string title = entry.title;
            if (entry.command == Command::undo && reason.empty()) title += ": " + p.view.undoLabel;
            if (entry.command == Command::redo && reason.empty()) title += ": " + p.view.redoLabel;
            title += std::string("###") + entry.name;
            if (ImGui::MenuItem(title.c_str(), keyText(entry.key).c_str(), checked(entry.command, p), reason.empty())) {
                p.run(entry.command);
            }
            commandTooltip(entry.command, reason);
            if (entry.command == Command::open) recentFiles(p);
        }
        if (std::string_view(menu) == "Rig" && ImGui::MenuItem("Rig page###rigPage")) p.state.page = Page::rig;
        ImGui::EndMenu();
    }
}

void deviceChips(Panel& p) {
    const CoreStatus& core = p.view.core;
    const CameraStatus& camera = p.view.camera;
    const auto fault = [&] { return !core.faultSeen && !core.lastFault.empty(); };
    if (fault()) {
        const std::string words = core.lastFault.size() > 60 ? core.lastFault.substr(0, 57) + "..." : core.lastFault;
        if (chip("###fault", words, colour::fault,
                 core.lastFault +
                     "\nThe light is safe: steady and white, the lens at rest. Click when you have seen this.")) {
            p.run(Command::acknowledgeFault);
        }
        return;
    }
    const bool compact = p.at.top.w < 1500 * p.scale;
    const ImU32 cameraDot = !camera.open ? colour::dim : camera.frozen ? colour::fault : colour::good;
    if (chip("###camera", camera.open && !compact ? camera.name : "Camera", cameraDot,
             !camera.open    ? "No camera: the scene is a picture. Choose one on the Scene page."
             : camera.frozen ? camera.name + ": the picture stands still since " +
                                   formatted(camera.frameAge_s, Unit::number) + " s."
                             : camera.name + ": live.")) {
        p.state.page = Page::scene;
    }
    const std::string kind = core.simulated ? kindOf(core) : std::string();
    const std::string simulated = core.simulated ? " (" + kind + ")" : "";
    const auto machine = [&](const char* id, const char* name, const std::string& says, bool well) {
        ImGui::SameLine(0, p.px(6));
        const ImU32 dot = !core.connected ? colour::fault : well ? colour::good : colour::warn;
        const std::string shown = name + (core.simulated ? " " + (compact ? kind.substr(0, 3) : kind) : std::string());
        if (chip(id, shown, dot,
                 core.connected ? says + simulated
                                : "The output core is not connected: what the room shows is not known here.")) {
            p.state.page = Page::rig;
        }
    };
    machine("###projector", "Projector", core.projector, core.projectorWell);
    machine("###lens", "Lens", core.lens, core.lensWell);
}

bool bigButton(Panel& p, const char* id, const char* words, float width, ImU32 ground, ImU32 ink, ImU32 edge,
               const std::string& badge, bool enabled) {
    const float height = p.px(kLiveTarget);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(id, {width, height}) && enabled;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + width, from.y + height};
    const float rounding = p.px(4);
    draw.AddRectFilled(from, to, enabled && ImGui::IsItemHovered() ? rgb(0x39424F) : ground, rounding);
    draw.AddRect(from, to, edge, rounding, 0, p.px(1.5));
    ImFont* strong = font(Font::strong);
    const ImVec2 extent = strong->CalcTextSizeA(strong->FontSize, 999, 0, words);
    const float shift = badge.empty() ? 0.0f : p.px(12);
    draw.AddText(strong, strong->FontSize, {from.x + (width - extent.x) / 2 - shift, from.y + (height - extent.y) / 2},
                 ink, words);
    if (!badge.empty()) {
        const ImVec2 size = ImGui::CalcTextSize(badge.c_str());
        const ImVec2 c{from.x + (width + extent.x) / 2 + p.px(3), from.y + height / 2};
        draw.AddRectFilled({c.x - p.px(4), c.y - size.y / 2 - p.px(2)},
                           {c.x + size.x + p.px(5), c.y + size.y / 2 + p.px(2)}, faded(colour::warn, 0.22), p.px(8));
        draw.AddText({c.x, c.y - size.y / 2}, colour::warn, badge.c_str());
    }
    return pressed;
}

void showButtons(Panel& p, float right) {
    const View& view = p.view;
    const float safeWidth = p.px(118), takeWidth = p.px(108), liveWidth = p.px(56), gap = p.px(8);
    const float top = (static_cast<float>(p.at.top.h) - p.px(kLiveTarget)) / 2;
    float x = right - safeWidth;
    ImGui::SetCursorPos({x, top});
    const bool steady = view.core.connected && view.core.light == Light::steady;
    // A dialog keeps the pointer from everything but itself; never from safe light.
    const ImVec2 corner = ImGui::GetCursorScreenPos(), mouse = ImGui::GetMousePos();
    const bool throughDialog = p.state.popupsOpen && ImGui::IsMouseClicked(ImGuiMouseButton_Left) &&
                               mouse.x >= corner.x && mouse.x < corner.x + safeWidth && mouse.y >= corner.y &&
                               mouse.y < corner.y + p.px(kLiveTarget);
    if (throughDialog) p.run(Command::safeLight);
    if (bigButton(p, "###safeLight", "SAFE LIGHT", safeWidth, steady ? colour::safe : colour::safeGround,
                  steady ? colour::ground : colour::safe, steady ? colour::safe : rgb(0x596373), "", true)) {
        p.run(Command::safeLight);
    }
    commandTooltip(Command::safeLight, steady ? "The light is steady now." : "");
    x -= takeWidth + gap;
    ImGui::SetCursorPos({x, top});
    // A thin line: what plays is not what is painted; the number says by how many edits.
    const bool differs = view.editsSinceTake > 0;
    const std::string reason = whyNot(Command::take, view, p.state);
    if (bigButton(p, "###take", "TAKE", takeWidth, colour::safeGround, reason.empty() ? colour::text : colour::dim,
                  differs ? colour::warn : colour::line, differs ? std::to_string(view.editsSinceTake) : "",
                  reason.empty())) {
        p.run(Command::take);
    }
    commandTooltip(Command::take, !reason.empty() ? reason
                                  : differs       ? std::to_string(view.editsSinceTake) + " edits are not on show yet."
                                                  : "What plays is what is painted.");
    x -= liveWidth + gap;
    ImGui::SetCursorPos({x, top});
    if (bigButton(p, "###live", "Live", liveWidth, view.liveTake ? rgb(0x4A4223) : colour::panel,
                  view.liveTake ? colour::warn : colour::dim, view.liveTake ? colour::warn : colour::line, "", true)) {
        p.run(Command::liveTake);
    }
    commandTooltip(Command::liveTake);
}

}  // namespace

void topBar(Panel& p) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(p.px(8), 0));
    ImGui::SetNextWindowPos(vec(p.at.top.x, p.at.top.y));
    ImGui::SetNextWindowSize(vec(p.at.top.w, p.at.top.h));
    ImGui::Begin("###top", nullptr, fixedFlags());
    ImGui::PopStyleVar();
    const auto width = static_cast<float>(p.at.top.w), height = static_cast<float>(p.at.top.h);
    const float row = ImGui::GetFrameHeight(), middle = (height - row) / 2;
    const float buttonsLeft = width - p.px(8 + 118 + 8 + 108 + 8 + 56 + 12);

    // Menus in a row of their own kind: a menu bar would fix its own height.
    ImGui::SetCursorPos({p.px(6), middle});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(p.px(14), p.px(7)));
    ImGui::BeginChild("###menu", {p.px(392), row}, false,
                      ImGuiWindowFlags_MenuBar | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
    if (ImGui::BeginMenuBar()) {
        menus(p);
        ImGui::EndMenuBar();
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();

    ImGui::SetCursorPos({p.px(404), middle});
    ImGui::PushClipRect({0, 0}, {buttonsLeft, height}, true);
    const bool steady = p.view.core.connected && p.view.core.light == Light::steady;
    chip("###mode",
         steady            ? "SAFE"
         : p.view.liveTake ? "LIVE"
                           : "EDIT",
         steady            ? colour::safe
         : p.view.liveTake ? colour::warn
                           : colour::focus,
         steady            ? "The room has steady white light and the lens rests. TAKE starts the show."
         : p.view.liveTake ? "Every change goes on show while you paint."
                           : "You paint; what plays changes only with TAKE.");
    ImGui::SameLine(0, p.px(10));
    deviceChips(p);
    ImGui::PopClipRect();
    showButtons(p, width - p.px(8));
    ImGui::End();
}

}  // namespace ilf::ui
