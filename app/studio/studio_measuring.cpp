// What the studio does while a rig is measured: the devices go to the measurer and come back, the light stays steady.
#include "app/rigs.h"
#include "app/studio/studio.h"
#include "ui/measure_page.h"

namespace ilf::app {

void Studio::on(const ui::Measure& request) {
    using Step = ui::Measure::Step;
    switch (request.step) {
    case Step::open:
        return measure();
    case Step::go:
        return measurer_.go();
    case Step::next:
        return measurer_.next();
    case Step::again:
        return measurer_.again();
    case Step::back:
        return measurer_.back();
    case Step::cancel:
        return measurer_.cancel();
    case Step::use:
        if (const auto rig = measurer_.measuredRig(editor_.document().rig)) {
            edit(SetRig{*rig});
            say("Planned with what was measured; undo brings back what was.", ui::Tone::note);
        }
        return;
    }
}

void Studio::measure() {
    if (registrar_.view())
        return say("A camera is being registered: close that page before measuring the rig.", ui::Tone::warning);
    const std::string& word = options_.rig.rig;
    ui::CoreStatus simulated;
    simulated.connected = true;
    // Without a word the core plays on simulated devices, whatever the project's rig is.
    if (word.empty() || word == kSimulatedRig) return say(ui::whyNotMeasured(simulated), ui::Tone::warning);
    const auto rig = rigFrom(word);
    const auto offered = rig ? measurer_.offer(word, *rig) : tl::unexpected(rig.error());
    if (!offered) say(offered.error().what, ui::Tone::warning);
}

void Studio::on(const ui::StartMeasuring& request) {
    measurer_.begin(request.setup);
    if (!measurer_.busy()) return;
    forgetTake();
    link_.safeLight();
    lendDevices();
}

void Studio::on(const ui::StoreMeasured& request) { measurer_.store(request.path); }

void Studio::lendDevices() {
    const bool wanted = measurer_.wantsDevices();
    if (wanted == lent_) return;
    lent_ = wanted;
    wanted ? link_.lendDevices() : link_.takeDevicesBack();
}

}  // namespace ilf::app
