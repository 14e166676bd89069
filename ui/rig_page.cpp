// The rig: how its devices are, how well the light keeps time, and its numbers.
#include <algorithm>

#include "ui/devices_card.h"
#include "ui/measure_page.h"
#include "ui/register_page.h"
#include "ui/widgets.h"

namespace ilf::ui {
namespace {

void rigNumbers(Panel& p) {
    const Rig& rig = p.document().rig;
    text(rig.name, colour::text, Font::strong);
    ImGui::SameLine();
    text(rig.provenance, rig.provenance == "measured" ? colour::good : colour::warn);
    const auto rate = [&](const char* label, const char* id, double value, FieldSpec spec, auto put) {
        if (const auto change = numberRow(p, label, id, value, spec)) {
            Rig next = rig;
            put(next, change->value);
            p.edit(change->commits, SetRig{next});
        }
    };
    derivedRow(p, "Projector",
               std::to_string(rig.projector.width) + " \u00d7 " + std::to_string(rig.projector.height) + " px");
    rate("Sweep", "###sweepRate", rig.sweepRate.si(),
         {Unit::hertz, 30.0, 240.0, 0.5, "Sweeps per second; below 60 Hz light in slots flickers."},
         [](Rig& r, double v) { r.sweepRate = Hertz::fromSi(v); });
    rate("Slots", "###slotRate", rig.slotRate.si(),
         {Unit::hertz, 60.0, 10000.0, 5.0, "Slots per second: a whole multiple of the sweep rate."},
         [](Rig& r, double v) { r.slotRate = Hertz::fromSi(v); });
    rate("Delay", "###delay", rig.projectorDelay.si(), {Unit::millisecond, 0.0, 0.05, 1e-5, "From trigger to light."},
         [](Rig& r, double v) { r.projectorDelay = Second::fromSi(v); });
    rate("Lens from", "###lensMin", rig.lensMin.si(), {Unit::dioptre, -30.0, 0.0, 0.02, "Least power of the lens."},
         [](Rig& r, double v) { r.lensMin = Dioptre::fromSi(v); });
    rate("Lens to", "###lensMax", rig.lensMax.si(), {Unit::dioptre, 0.0, 30.0, 0.02, "Largest power of the lens."},
         [](Rig& r, double v) { r.lensMax = Dioptre::fromSi(v); });
    primariesRows(p);
}

void outputCore(Panel& p) {
    const CoreStatus& core = p.view.core;
    // A projector that cannot be asked may show anything.
    const bool asked = std::ranges::all_of(core.devices, [](const Device& device) {
        return device.what == "lenses" || device.health == DeviceHealth::well ||
               device.health == DeviceHealth::wrongMode;
    });
    derivedRow(p, "Light",
               !asked                         ? "not known"
               : core.light == Light::steady  ? "steady white"
               : core.light == Light::slotted ? "plays a program"
                                              : "unknown");
    derivedRow(p, "Revision",
               std::to_string(core.revisionPlayed) + " played, " + std::to_string(core.revisionSent) + " sent");
    derivedRow(p, "Swaps", std::to_string(core.swaps) + ", " + std::to_string(core.droppedUpdates) + " dropped");
    derivedRow(p, "To light", formatted(core.strokeToSwap_ms * 1e-3, Unit::millisecond), "From a stroke to its swap.");
    for (const TimingRow& row : timingRows(core))
        derivedRow(p, row.label, row.value, row.help);
    if (!core.lastFault.empty()) wrapped("Last fault: " + core.lastFault, core.faultSeen ? colour::dim : colour::fault);
    for (const std::string& limit : core.limits)
        wrapped(limit, colour::dim, Font::small);
}

}  // namespace

void rigPage(Panel& p) {
    devicesCard(p);
    measureButton(p);
    registerCard(p);
    if (p.view.core.connected) outputCore(p);
    ImGui::Dummy({1, p.px(4)});
    heading("RIG");
    rigNumbers(p);
}

}  // namespace ilf::ui
