// What the stage says of its devices: status lines, and a line for each on the device panel.
#include "core/base/as_text.h"
#include "core/plan/words.h"
#include "devices/rig/lightcrafter_stage.h"

namespace ilf::devices {
StageReport LightCrafterStage::report() const {
    StageReport report;
    report.simulated = report.emulated = rig_.emulated;
    report.light = light_ == Light::slotted ? LightMode::slotted : LightMode::steady;
    lens_.report(report, light_ == Light::slotted);
    report.well = projector_ && lens_.there() && videoThere_ && light_ != Light::unknown;
    report.projectorLine = projectorLine();
    report.devices = deviceLines();
    return report;
}

std::string LightCrafterStage::projectorLine() const {
    const std::string board = projector_ ? projector_->name() : "LightCrafter 4500";
    if (!projector_)
        return board + ": no answer" + (videoThere_ ? ", it is sent white; " : "; ") + "its light is not known";
    const std::string light = light_ != Light::white ? "its light is not known"
                              : ownWhite_            ? "steady white of its own"
                                                     : "steady white";
    if (!videoThere_) return board + ": its display " + rig_.video->display().connector + " is gone; " + light;
    if (light_ != Light::slotted) return board + ": " + light;
    // Where the display's rate is not measured, it is taken for what the sweep was planned for.
    const Hertz rate = mode_.refresh > 0.0_Hz ? mode_.refresh : sweeps_;
    return board + ": " + std::to_string(running_ ? running_->entries.size() : 0) + " slots at " +
           asText("%.2f Hz", rate.si());
}

std::vector<DeviceLine> LightCrafterStage::deviceLines() const {
    const bool slotted = light_ == Light::slotted;
    const std::string projector =
        slotted ? "It shows " + std::to_string(running_ ? running_->entries.size() : 0) + " slots a sweep."
        : ownWhite_ && light_ == Light::white
            ? "It shows steady white light of its own, without video; TAKE plays the slots."
        : light_ == Light::white ? "It shows steady white light; TAKE plays the slots."
                                 : "It was told to show plain video; its light is not known.";

    std::string display = slotted ? "It carries the slots" : "It carries white";
    display += ", " + std::to_string(mode_.size.width) + "x" + std::to_string(mode_.size.height);
    display += mode_.refresh > 0.0_Hz ? " at " + ilf::inWords(mode_.refresh.si(), 2) + " Hz"
                                      : "; how often a second is not measured";

    return {projectorKnown_.line(projector), displayKnown_.line(display + "."), lens_.line()};
}

}  // namespace ilf::devices
