// What the stage says of its devices: status lines, and a line for each on the device panel.
#include <array>
#include <cmath>

#include "core/base/as_text.h"
#include "core/plan/words.h"
#include "devices/rig/lightcrafter_stage.h"

namespace ilf::devices {
void LightCrafterStage::Known::answered(const std::string& called) {
    ever = true;
    name = called;
    if (health != DeviceHealth::wrongMode) cleared();
}

tl::unexpected<Error> LightCrafterStage::Known::lost(const Error& error) {
    if (error.fault == Fault::notFound) return missing(error);
    health = DeviceHealth::silent;
    trouble = error.what;
    return tl::unexpected<Error>(error);
}

tl::unexpected<Error> LightCrafterStage::Known::missing(const Error& error) {
    health = ever ? DeviceHealth::unplugged : DeviceHealth::absent;
    trouble = error.what;
    return tl::unexpected<Error>(error);
}

tl::unexpected<Error> LightCrafterStage::Known::wrong(Error error) {
    health = DeviceHealth::wrongMode;
    trouble = error.what;
    return tl::unexpected<Error>(std::move(error));
}

void LightCrafterStage::Known::cleared() {
    health = DeviceHealth::well;
    trouble.clear();
}

StageReport LightCrafterStage::report() const {
    StageReport report;
    report.simulated = report.emulated = rig_.emulated;
    report.light = light_ == Light::slotted ? LightMode::slotted : LightMode::steady;
    report.lens = !told_ ? LensMode::rest : told_->still() ? LensMode::holding : LensMode::sweeping;
    report.lensPower = report.low = report.high = rest_;
    if (told_) {
        const double now_s = std::chrono::duration<double>(rig_.clock.now()).count();
        report.low = told_->low;
        report.high = told_->high;
        report.lensPower = told_->still() ? told_->low : predicted_.powerAt(std::llround(now_s * 1e9));
    }
    report.well = projector_ && lens_ && videoThere_ && light_ != Light::unknown && (told_ || resting_);
    if (light_ == Light::slotted && phase_)
        report.timing =
            StageTiming{phase_->locked, phase_->most, phase_->jitter, phase_->driftPpm,
                        static_cast<std::uint64_t>(std::max<std::int64_t>(0, phase_->missing - missingBefore_))};
    if (lens_) report.lensTemperature_C = temperature_C_;
    report.projectorLine = projectorLine();
    report.lensName = lens_ ? lens_->name() : "lenses";
    report.lensLine = lensLine();
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
    const Hertz rate = mode_.refresh > 0.0_Hz || !told_ ? mode_.refresh : told_->rate;
    return board + ": " + std::to_string(running_ ? running_->entries.size() : 0) + " slots at " +
           asText("%.2f Hz", rate.si());
}

std::string LightCrafterStage::phaseWords() const {
    if (!phase_) return "";
    return asText("; phase within %.0f us", phase_->most.in(1.0_us)) + asText(", %+.0f ppm", phase_->driftPpm);
}

std::string LightCrafterStage::lensLine() const {
    if (!lens_)
        return resting_ ? "lenses: at rest after a fault, to be opened again"
                        : "lenses: no answer; where they are is not known";
    if (!told_) return lens_->name() + asText(": at rest at %.2f D", rest_.si());
    return lens_->name() + asText(": told %.2f", told_->low.si()) + asText(" to %.2f D", told_->high.si()) +
           phaseWords() + (temperature_C_ ? "" : "; its temperature is not known");
}

std::vector<DeviceLine> LightCrafterStage::deviceLines() const {
    const auto line = [](const char* what, const Known& known, const std::string& usual, const std::string& does) {
        const std::string name = known.name.empty() ? usual : known.name;
        if (!known.trouble.empty()) return DeviceLine{what, known.health, name, known.trouble};
        const bool looked = known.health != DeviceHealth::absent;
        return DeviceLine{what, known.health, name, looked ? does : "It was not looked for yet."};
    };
    const bool slotted = light_ == Light::slotted;
    const std::string projector =
        slotted ? "It shows " + std::to_string(running_ ? running_->entries.size() : 0) + " slots a sweep."
        : ownWhite_ && light_ == Light::white
            ? "It shows steady white light of its own, without video; TAKE plays the slots."
        : light_ == Light::white ? "It shows steady white light; TAKE plays the slots."
                                 : "It was told to show plain video; its light is not known.";

    const std::string connector = rig_.video->display().connector;
    std::string display = slotted ? "It carries the slots" : "It carries white";
    display += ", " + std::to_string(mode_.size.width) + "x" + std::to_string(mode_.size.height);
    display += mode_.refresh > 0.0_Hz ? " at " + ilf::inWords(mode_.refresh.si(), 2) + " Hz"
                                      : "; how often a second is not measured";

    std::string lenses = "They rest at " + ilf::inWords(rest_) + "; TAKE plays the sweep.";
    if (told_) {
        lenses =
            (told_->still() ? "They hold " + ilf::inWords(told_->low)
                            : "They sweep " + ilf::inWords(told_->low.si(), 2) + " to " + ilf::inWords(told_->high)) +
            phaseWords();
        // Without a sensor nothing can be trimmed to it.
        lenses += temperature_C_ ? ", at " + ilf::inWords(*temperature_C_, 1) + " degrees C."
                                 : "; their temperature is not measured, so what warming coils do to their powers is "
                                   "not made up for.";
    }
    return {line("projector", projectorKnown_, "LightCrafter 4500", projector),
            line("display", displayKnown_, connector.empty() ? "the projector's display" : connector, display + "."),
            line("lenses", lensesKnown_, "USB-1208FS-Plus", lenses)};
}

}  // namespace ilf::devices
