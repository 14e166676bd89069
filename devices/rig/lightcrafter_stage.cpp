#include "devices/rig/lightcrafter_stage.h"

#include <cmath>

namespace ilf::devices {
namespace {

// Of video nobody measured: the slowest there is.
constexpr Second kLongestFrame = 40.0_ms;
// Half of what separates 59.94 from 60 Hz. What is left is the phase lock's to judge.
constexpr double kMostOff = 500e-6;

std::string usualName(const DisplayIdentity& display) {
    return display.connector.empty() ? "the projector's display" : display.connector;
}

}  // namespace

LightCrafterStage::LightCrafterStage(LightCrafterRig rig)
    : rig_(std::move(rig)), lens_(rig_.openLens, rig_.clock, "TRIG_OUT_2"),
      projectorKnown_("projector", "LightCrafter 4500"), displayKnown_("display", usualName(rig_.video->display())) {
    (void)lens_.restsAt(rig_.rest);
}

LightCrafterStage::~LightCrafterStage() {
    if (projector_ || lens_.there()) safeLight();
}

Result<void> LightCrafterStage::load(const Program& program) {
    loaded_.reset();
    if (auto ok = checked(program); !ok) return ok;
    auto frame = rig_.packed(program);
    if (!frame) return tl::unexpected(frame.error());
    loaded_ = Loaded{program, *std::move(frame)};
    return {};
}

bool LightCrafterStage::playsLikeLoaded() const {
    return light_ == Light::slotted && running_ == loaded_->frame.sequence &&
           lens_.plays(loaded_->program.waveform, loaded_->program.projectorDelay);
}

Result<void> LightCrafterStage::swap() {
    if (!loaded_) return fail(Fault::device, "Nothing is loaded that could be put on show.");
    const bool only = playsLikeLoaded();
    auto done = only ? published(loaded_->frame.picture) : began();
    if (done) done = confirmed();
    if (!done) return faulted(done.error());
    projectorKnown_.cleared();
    displayKnown_.cleared();
    lens_.cleared();
    return {};
}

Result<void> LightCrafterStage::began() {
    const auto& [program, frame] = *loaded_;
    if (light_ == Light::slotted) {
        safeTold_ = false;
        if (auto white = published(white_); !white) return white;
        light_ = Light::white;
    }
    if (auto there = reached(program.waveform.rest); !there) return there;
    safeTold_ = false;
    sweeps_ = program.waveform.rate;
    if (auto back = backToVideo(); !back) return back;
    if (auto well = videoWell(); !well) return well;
    const double off = mode_.refresh / program.waveform.rate - 1.0;
    if (mode_.refresh > 0.0_Hz && std::abs(off) > kMostOff)
        return displayKnown_.wrong(
            {Fault::device, "The projector's video comes at " + std::to_string(mode_.refresh.si()) +
                                " Hz, the program sweeps at " + std::to_string(program.waveform.rate.si()) +
                                " Hz; set the display to that rate (59.94 is not 60)."});
    if (frame.picture.size() != mode_.size)
        return displayKnown_.wrong(
            {Fault::device, "The projector's display does not have the mode its slots are packed for; set 912x1140."});
    if (auto settled = lens_.settled(program.waveform, program.projectorDelay); !settled) return settled;
    if (auto run = patternsRun(frame.sequence); !run) return run;
    if (auto locked = lens_.inStep(); !locked) return locked;
    if (auto well = confirmed(); !well) return well;
    light_ = Light::slotted;  // even if the order fails: it may have got through
    return published(frame.picture);
}

Result<std::chrono::nanoseconds> LightCrafterStage::lit(const VideoFrame& frame) {
    const auto out = rig_.video->show(frame);
    if (!out) return displayKnown_.missing(out.error());
    const Second period = mode_.refresh > 0.0_Hz ? 1.0 / mode_.refresh : kLongestFrame;
    const auto began = out->at + inNs(running_ ? period : 0.0_s);
    waitUntil(began);
    return began;
}

Result<void> LightCrafterStage::published(const VideoFrame& frame) {
    return lit(frame).map([&](std::chrono::nanoseconds began) { lightBegan_ = began; });
}

Result<void> LightCrafterStage::patternsRun(const dlpc350::PatternSequence& sequence) {
    if (running_ == sequence) return {};
    running_.reset();
    light_ = Light::unknown;  // dark while it is arranged
    if (auto started = projector_->start(sequence); !started) return projectorKnown_.wrong(started.error());
    running_ = sequence;
    light_ = Light::white;
    return {};
}

void LightCrafterStage::waitUntil(std::chrono::nanoseconds time) {
    const auto now = rig_.clock.now();
    if (time > now) rig_.clock.wait(time - now);
}

}  // namespace ilf::devices
