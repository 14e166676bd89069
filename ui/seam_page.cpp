// The seam page: blending and feather, the seam at the cursor, and every border with what hides it.
#include <algorithm>
#include <array>
#include <cmath>

#include "ui/icons.h"
#include "ui/seam_marks.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

std::string nameOf(const Document& document, const RegionId& id) {
    const Region* region = findRegion(document, id);
    return region != nullptr ? region->name : id;
}

void cursorSeam(Panel& p) {
    const auto& profile = p.view.computed.seam;
    if (!profile) {
        wrapped("Hold the cursor near the border of a blurred region to see its seam.", colour::dim, Font::small);
        return;
    }
    const Region* blurred = findRegion(p.document(), profile->blurred);
    const Region* other = findRegion(p.document(), profile->other);
    if (blurred != nullptr && other != nullptr) derivedRow(p, "between", blurred->name + " / " + other->name);
    derivedRow(p, profile->gap ? "gap" : "overlap", formatted(profile->seamWidth_mm * 1e-3, Unit::millimetre),
               "Without blending: a dark gap or a bright overlap this wide.");
    if (profile->depthStep) {
        wrapped("One surface stands before the other here, so nothing is blended: what shows is the outline of the "
                "nearer one.",
                colour::dim, Font::small);
    }
    const auto worst = [&](const char* label, const EyeProfile& eye) {
        derivedRow(p, label,
                   formatted(eye.worstWeberBefore, Unit::percent) + " \u2192 " +
                       formatted(eye.worstWeberAfter, Unit::percent),
                   "Worst Weber contrast along the border, before and after blending.");
    };
    worst("left eye", profile->left);
    worst("right eye", profile->right);
}

/// A feather that the borders ask for, as the one button that sets it.
void featherButton(Panel& p, const BorderSeam& seam) {
    const Seam& now = p.document().seam;
    // Whole millimetres, within what a feather may be.
    const Metre width = std::min(0.2_m, std::ceil(seam.hiding.width.in(1.0_mm) - 1e-6) * 1.0_mm);
    if (seam.depthStep || now.blending != Blending::closedForm || width <= now.feather) return;
    const std::string words = "Feather " + std::to_string(std::lround(width.in(1.0_mm))) + " mm";
    if (ImGui::SmallButton((words + "###hide").c_str())) p.commit(SetSeam{{now.blending, width}});
    if (ImGui::IsItemHovered()) {
        tooltip(std::string(seam.hiding.clamped ? "As wide as the region has room for; leaves about "
                                                : "Hides this border, errors included; leaves about ") +
                formatted(seam.hiding.left, Unit::percent) + ". One feather serves all borders.");
    }
}

void borderRow(Panel& p, const BorderSeam& seam) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetTextLineHeight();
    draw.AddCircleFilled({at.x + p.px(5), at.y + height / 2}, p.px(4), seamColour(seam.worst()));
    ImGui::SetCursorScreenPos({at.x + p.px(14), at.y});
    ImGui::BeginGroup();
    text(nameOf(p.document(), seam.blurred) + " / " + nameOf(p.document(), seam.other));
    text("L " + formatted(seam.now[0].weber, Unit::percent) + "  R " + formatted(seam.now[1].weber, Unit::percent) +
             (seam.depthStep
                  ? "  depth step"
                  : "  with errors " + formatted(std::max(seam.combined[0], seam.combined[1]), Unit::percent)),
         colour::dim, Font::small);
    ImGui::EndGroup();
    if (ImGui::IsItemHovered()) {
        std::string more = seam.says;
        for (const SeamUnderError& error : seam.errors) {
            more +=
                "\n" + error.what + ": " + formatted(std::max(error.eyes[0].weber, error.eyes[1].weber), Unit::percent);
        }
        tooltip(more);
    }
    ImGui::SetCursorScreenPos({at.x + p.px(14), ImGui::GetCursorScreenPos().y});
    featherButton(p, seam);
}

void allBorders(Panel& p) {
    ImGui::Dummy({1, p.px(4)});
    heading("BORDERS");
    const auto& seams = p.view.computed.seams;
    if (!seams) {
        wrapped("Borders are looked at when nothing has been painted for a moment.", colour::dim, Font::small);
        return;
    }
    if (seams->empty()) {
        wrapped("No border between displaced light and other light.", colour::dim, Font::small);
        return;
    }
    for (const BorderSeam& seam : *seams) {
        ImGui::PushID((seam.blurred + "/" + seam.other).c_str());
        borderRow(p, seam);
        ImGui::PopID();
    }
    wrapped("Simulated: even light, nothing but the border. Texture hides more.", colour::dim, Font::small);
}

}  // namespace

void seamPage(Panel& p) {
    const Seam& seam = p.document().seam;
    constexpr std::array<const char*, 4> names{"none", "linear, object", "linear, perceived", "closed form"};
    rowLabel(p, "Blending", "How the border between sharp and blurred light is blended.");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("###blending", names[static_cast<std::size_t>(seam.blending)])) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (ImGui::Selectable(names[i], i == static_cast<std::size_t>(seam.blending))) {
                p.commit(SetSeam{{static_cast<Blending>(i), seam.feather}});
            }
        }
        ImGui::EndCombo();
    }
    const FieldSpec spec{Unit::millimetre, 0.0, 0.2, 0.0001,
                         "Width of the ramp across the surface, in mm at its distance."};
    if (const auto change = numberRow(p, "Feather", "###feather", seam.feather.si(), spec)) {
        p.edit(change->commits, SetSeam{{seam.blending, Metre::fromSi(change->value)}});
    }
    cursorSeam(p);
    allBorders(p);
}

}  // namespace ilf::ui
