#include "ui/devices_card.h"

#include "ui/icons.h"
#include <utility>

#include "core/base/as_text.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

ImU32 inkOf(DeviceHealth health) {
    switch (health) {
    case DeviceHealth::well:
        return colour::good;
    case DeviceHealth::absent:
        return colour::dim;
    case DeviceHealth::wrongMode:
        return colour::warn;
    case DeviceHealth::unplugged:
    case DeviceHealth::silent:
        return colour::fault;
    }
    return colour::dim;
}

std::string microseconds(double seconds) { return asText("%.0f \u00b5s", seconds * 1e6); }

/// Devices that report nothing of their own have the two lines of every rig.
std::vector<Device> devicesOf(const CoreStatus& core) {
    if (!core.devices.empty()) return core.devices;
    const auto health = [](bool well) { return well ? DeviceHealth::well : DeviceHealth::silent; };
    return {{"projector", health(core.projectorWell), "Projector", core.projector},
            {"lenses", health(core.lensWell), "Lenses", core.lens}};
}

void deviceRow(Panel& p, const Device& device) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImU32 ink = inkOf(device.health);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), radius = p.px(4);
    const float right = at.x + ImGui::GetContentRegionAvail().x;
    // Not by colour alone: a ring for what is missing, a disc for what is there, and the word.
    const ImVec2 centre{at.x + radius + p.px(1), at.y + line / 2};
    if (device.health == DeviceHealth::absent || device.health == DeviceHealth::unplugged)
        draw.AddCircle(centre, radius, ink, 0, p.px(1.5));
    else
        draw.AddCircleFilled(centre, radius, ink);
    ImGui::SetCursorScreenPos({at.x + p.px(16), at.y});
    std::string what = device.what;
    if (!what.empty() && what[0] >= 'a' && what[0] <= 'z') what[0] = static_cast<char>(what[0] - 'a' + 'A');
    text(what, colour::text, Font::strong);
    if (!device.line.empty()) tooltip(device.line);
    const std::string state = word(device.health);
    ImGui::SameLine(right - ImGui::CalcTextSize(state.c_str()).x - ImGui::GetWindowPos().x);
    text(state, ink);
    // A device that is well has nothing to say that its word does not; its sentence is in the tooltip.
    const bool well = device.health == DeviceHealth::well;
    for (const auto& [words, colour] :
         {std::pair(device.name, colour::dim), std::pair(well ? std::string() : device.line, colour::text)}) {
        if (words.empty()) continue;
        ImGui::SetCursorScreenPos({at.x + p.px(16), ImGui::GetCursorScreenPos().y});
        wrapped(words, colour, Font::small);
    }
    ImGui::Dummy({1, p.px(3)});
}

/// Which rig, and where rigs are kept: files of their own, since one room is the same for every project.
void rigChoice(Panel& p) {
    if (!p.state.rigWanted.empty()) {
        wrapped("What plays stops: steady light, lens at rest. The output core then starts with " +
                    (p.state.rigWanted.find('/') == std::string::npos ? "the " + p.state.rigWanted + " devices."
                                                                      : p.state.rigWanted + "."),
                colour::text, Font::small);
        if (ImGui::Button("Stop and change###changeRig"))
            p.requests.push_back(UseRig{std::exchange(p.state.rigWanted, {})});
        ImGui::SameLine();
        if (ImGui::Button("Cancel###keepRig")) p.state.rigWanted.clear();
        return;
    }
    const CoreStatus& core = p.view.core;
    const int now = !core.connected ? -1 : core.emulated ? 1 : core.simulated ? 0 : 2;
    if (const auto chosen =
            choice("###rigKind", {"Simulated", "Emulated", "File\u2026"}, now, ImGui::GetContentRegionAvail().x)) {
        if (*chosen == 2)
            openFileDialog(p.state, FileDialog::Purpose::openRig, p.view);
        else if (*chosen != now)
            wantRig(p, *chosen == 0 ? "simulated" : "emulated");
    }
    if (ImGui::Button("Save this rig\u2026###saveRig")) openFileDialog(p.state, FileDialog::Purpose::saveRig, p.view);
}

}  // namespace

void wantRig(Panel& p, const std::string& rig) {
    if (p.view.core.connected && p.view.core.light == Light::slotted)
        p.state.rigWanted = rig;
    else
        p.requests.push_back(UseRig{rig});
}

std::string kindOf(const CoreStatus& core) {
    return core.emulated ? "emulated" : core.simulated ? "simulated" : "hardware";
}

std::string word(DeviceHealth health) {
    switch (health) {
    case DeviceHealth::well:
        return "well";
    case DeviceHealth::absent:
        return "not found";
    case DeviceHealth::unplugged:
        return "unplugged";
    case DeviceHealth::wrongMode:
        return "wrong mode";
    case DeviceHealth::silent:
        return "not answering";
    }
    return "";
}

std::vector<TimingRow> timingRows(const CoreStatus& core) {
    std::vector<TimingRow> rows;
    if (core.timing) {
        const CoreStatus::Timing& t = *core.timing;
        rows.push_back({"Phase",
                        t.locked ? microseconds(t.phase.si()) + ", \u00b1" + microseconds(t.jitter.si()) : "not locked",
                        "Farthest of the last two seconds between the sweep and the projector's triggers, and their "
                        "scatter."});
        const std::string drift = asText("%+.1f ppm", t.driftPpm);
        rows.push_back({"Drift", drift, "Of the lenses' clock against the projector's; followed sample by sample."});
        rows.push_back({"Triggers", std::to_string(t.missedTriggers) + " missed", "Since slotted light came on."});
    }
    if (core.lensTemperature_C) {
        const std::string warm = asText("%.1f \u00b0C", *core.lensTemperature_C);
        rows.push_back({"Lens", warm, "Temperature of the lens."});
    }
    return rows;
}

void devicesCard(Panel& p) {
    const CoreStatus& core = p.view.core;
    heading("DEVICES");
    if (p.view.measuring && p.view.measuring->holdsDevices) {
        wrapped("Lent to measuring: the output core is stopped and the display stays white.", colour::warn);
        return;
    }
    if (!core.connected) {
        wrapped("Not connected: what the room shows is not known here. The studio keeps trying.", colour::fault);
        rigChoice(p);
        return;
    }
    const std::string kind = kindOf(core);
    const float width = ImGui::CalcTextSize(kind.c_str()).x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
    text(kind, core.simulated ? colour::warn : colour::good);
    for (const Device& device : devicesOf(core))
        deviceRow(p, device);
    rigChoice(p);
}

}  // namespace ilf::ui
