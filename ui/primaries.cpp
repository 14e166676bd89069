// The rig's primaries: the wavelengths its light is mixed from, for eyes that focus each colour elsewhere.
#include <array>

#include "ui/widgets.h"

namespace ilf::ui {
namespace {

Metre nanometres(double nm) { return Metre::fromSi(nm / 1e9); }

/// Dominant wavelengths of the LEDs in the DLP LightCrafter 4500.
std::array<Metre, 3> lightCrafter() { return {nanometres(623), nanometres(530), nanometres(460)}; }

}  // namespace

void primariesRows(Panel& p) {
    const Rig& rig = p.document().rig;
    const auto put = [&](bool commits, std::optional<std::array<Metre, 3>> primaries) {
        Rig next = rig;
        next.primaries = primaries;
        p.edit(commits, SetRig{std::move(next)});
    };
    rowLabel(p, "Primaries",
             "Dominant wavelengths of the projector's red, green and blue light. Known, a perceived view can show each "
             "colour in the focus the eye has for it (Wearer page).");
    const bool preset = rig.primaries == lightCrafter();
    constexpr std::array<const char*, 3> kChoices{"not known", "LightCrafter 4500 460/530/623 nm", "typed"};
    const std::size_t now = !rig.primaries ? 0 : preset ? 1 : 2;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("###primaries", kChoices[now])) {
        if (ImGui::Selectable(kChoices[0], now == 0)) put(true, std::nullopt);
        if (ImGui::Selectable(kChoices[1], now == 1)) put(true, lightCrafter());
        ImGui::EndCombo();
    }
    if (!rig.primaries) return;
    constexpr std::array<const char*, 3> kLabels{"  red, nm", "  green, nm", "  blue, nm"};
    constexpr std::array<const char*, 3> kIds{"###red", "###green", "###blue"};
    for (std::size_t i = 0; i < kLabels.size(); ++i) {
        const FieldSpec spec{Unit::number, 380.0, 780.0, 0.5, "Dominant wavelength, from 380 to 780 nm."};
        if (const auto change = numberRow(p, kLabels[i], kIds[i], (*rig.primaries)[i].si() * 1e9, spec)) {
            auto next = *rig.primaries;
            next[i] = nanometres(change->value);
            put(change->commits, next);
        }
    }
}

}  // namespace ilf::ui
