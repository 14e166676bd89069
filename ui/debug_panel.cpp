#include "ui/debug_panel.h"

#include <cstdio>

#include "ui/widgets.h"

namespace ilf::ui {
namespace {

std::string ms(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f ms", value);
    return text;
}

std::string of(int part, int whole) { return std::to_string(part) + " of " + std::to_string(whole); }

DebugSection viewSection(const ViewCounters& c, const Computed& computed) {
    return {"VIEW, " + computed.viewRung,
            {{"tiles computed", of(c.computed, c.tiles), "Worked out for the last view, of 64 x 32 pixels each."},
             {"  unchanged", std::to_string(c.unchanged), "Skipped: no edit since the view before reaches them."},
             {"  plain", std::to_string(c.plain), "Skipped: nothing is blurred there, they are the picture."},
             {"  dark", std::to_string(c.dark), "Skipped: no light reaches them."},
             {"lights", std::to_string(c.lights) + " lit, " + std::to_string(c.darkLights) + " dark",
              "Powers of the lens at which something is lit, and levels whose image is dark."},
             {"surfaces blurred", std::to_string(c.blurred), "Over all tiles worked out, in every light."},
             {"  sharp", std::to_string(c.sharp), "Copied or moved, not blurred."},
             {"  unlit", std::to_string(c.unlit), "Skipped: no light on them near the tile."},
             {"  hidden", std::to_string(c.hidden), "Skipped: behind what hides all of the tile."},
             {"conflict tiles", std::to_string(c.conflicts),
              "Where blurred surfaces hide each other and the pupil was cut into cells."},
             {"geometry", ms(c.geometry_ms), "Surfaces and what hides what."},
             {"light", ms(c.light_ms), "Light on the surfaces."},
             {"tiles", ms(c.tiles_ms), "The view itself."},
             {"in all", ms(computed.view_ms), "With the conversion for the screen."}}};
}

}  // namespace

std::vector<DebugSection> debugSections(const Computed& computed) {
    std::vector<DebugSection> sections;
    if (computed.viewCounters) sections.push_back(viewSection(*computed.viewCounters, computed));
    if (computed.compiled != nullptr) {
        const CompileCounters& c = computed.counters;
        sections.push_back({"PROGRAM",
                            {{"tiles computed", of(c.computed, c.tiles), "Of all slot images together."},
                             {"  unchanged", std::to_string(c.unchanged), "Taken from the compile before."},
                             {"  uniform", std::to_string(c.uniform), "The same all over: nothing to work out."},
                             {"seam tiles", std::to_string(c.seamTiles), "Where light that an eye sees moved ends."},
                             {"plan", ms(computed.plan_ms), "Sweep, levels and slots."},
                             {"compile", ms(computed.compile_ms), "Slot images."}}});
    }
    sections.push_back({"FRAME",
                        {{"own work", ms(computed.frameOwn_ms),
                          "Processor time of the window's last frame: input, uploads, panels, draw lists."},
                         {"swap", ms(computed.frameSwap_ms), "Software GL fills the pixels here."}}});
    return sections;
}

void debugPanel(Panel& p) {
    if (!p.state.debugOpen) return;
    const std::vector<DebugSection> sections = debugSections(p.view.computed);
    ImFont* small = font(Font::small);
    const double line = static_cast<double>(small->FontSize) + 3 * p.scale;
    double lines = 0;
    for (const DebugSection& section : sections)
        lines += static_cast<double>(section.rows.size()) + 1.6;
    const double width = 232 * p.scale, height = lines * line + 14 * p.scale;
    const Rect at{p.at.canvas.x + 12 * p.scale, p.at.canvas.y + 40 * p.scale, width,
                  std::min(height, p.at.canvas.h - 52 * p.scale)};
    if (at.empty()) return;
    ImGui::SetNextWindowPos(vec(at.x, at.y));
    ImGui::SetNextWindowSize(vec(at.w, at.h));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, rgb(0x101317, 225));
    // Unlike panels it lies before the picture; opening it must not take the keys away from the canvas.
    ImGui::Begin("###debug", nullptr,
                 (fixedFlags() & ~(ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar)) |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PopStyleColor();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto write = [&](double x, double y, const std::string& words, ImU32 ink) {
        draw.AddText(small, small->FontSize, vec(x, y), ink, words.c_str());
    };
    double y = at.y + 6 * p.scale - static_cast<double>(ImGui::GetScrollY());
    for (const DebugSection& section : sections) {
        write(at.x + 10 * p.scale, y, section.title, colour::dim);
        y += 1.2 * line;
        for (const DebugRow& row : section.rows) {
            write(at.x + 10 * p.scale, y, row.label, colour::text);
            const float wide = small->CalcTextSizeA(small->FontSize, 4096, 0, row.value.c_str()).x;
            write(at.right() - 10 * p.scale - static_cast<double>(wide), y, row.value, colour::derived);
            ImGui::SetCursorScreenPos(vec(at.x, y));
            ImGui::Dummy(vec(width, line));
            tooltip(row.help);
            y += line;
        }
        y += 0.4 * line;
    }
    ImGui::End();
}

}  // namespace ilf::ui
