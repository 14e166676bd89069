#include "devices/plugin/plugin_stage.h"

#include <cmath>
#include <exception>
#include <utility>

#include "core/plan/words.h"
#include "devices/plugin/slot_pictures.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kTryEvery = 1s;
// Half of what separates 59.94 from 60 Hz. What is left is the phase lock's to judge.
constexpr double kMostOff = 500e-6;

PluginConfiguration timing(const Program& program, int bits) {
    return {PluginTrigger::ownClock, static_cast<int>(program.imageOfSlot.size()), bits, program.slotRate, 0.1_s};
}

}  // namespace

PluginStage::~PluginStage() {
    if (projector_ || lens_.there()) safeLight();
}

Result<void> PluginStage::load(const Program& program) {
    loaded_.reset();
    if (auto ok = checked(program); !ok) return ok;
    loaded_ = Loaded{program, timing(program, rig_.bits), slotPictures(program, rig_.bits)};
    if (!playsLikeLoaded()) return {};  // its slots are another number: they go up when the old ones end
    safeTold_ = false;
    if (auto sent = uploaded(loaded_->pictures); !sent) return faulted(sent.error());
    loaded_->uploaded = true;
    return {};
}

bool PluginStage::playsLikeLoaded() const {
    return light_ == Light::slotted && projector_ && running_ == loaded_->how &&
           projector_->description().raster == loaded_->program.projector &&
           lens_.plays(loaded_->program.waveform, loaded_->program.projectorDelay);
}

Result<void> PluginStage::swap() {
    if (!loaded_) return fail(Fault::device, "Nothing is loaded that could be put on show.");
    safeTold_ = false;
    const bool only = playsLikeLoaded();
    Result<void> done;
    if (!only)
        done = began();
    else if (!loaded_->uploaded)
        done = uploaded(loaded_->pictures);
    if (done) done = swapped();
    if (done) done = confirmed();
    if (!done) return faulted(done.error());
    if (!only) slottedAt_ = status_;  // the white slots before were counted too
    lightBegan_ = rig_.clock.now();
    loaded_->uploaded = false;  // the back buffer is empty now
    known_.cleared();
    lens_.cleared();
    return {};
}

/// All up to the swap that lights the program's slots.
Result<void> PluginStage::began() {
    const Program& program = loaded_->program;
    const PluginConfiguration& how = loaded_->how;
    if (light_ == Light::slotted && running_)  // not where it is only feared, of a projector that was lost
        if (auto white = whiteInSlots(*running_); !white) return white;
    if (auto all = reached(program.waveform.rest); !all) return all;
    safeTold_ = false;
    if (auto fits = projector_->possible(how); !fits) return known_.wrong(fits.error());
    if (projector_->description().raster != program.projector)
        return fail(Fault::outOfRange, "The program is for " + std::to_string(program.projector.width) + "x" +
                                           std::to_string(program.projector.height) + " pixels, " + projector_->name() +
                                           " has " + std::to_string(projector_->description().raster.width) + "x" +
                                           std::to_string(projector_->description().raster.height) +
                                           "; set the rig's projector to that.");
    if (auto settled = lens_.settled(program.waveform, program.projectorDelay); !settled) return settled;
    if (auto run = slotsRun(how); !run) return run;
    if (auto locked = lens_.inStep(); !locked) return locked;
    if (auto well = confirmed(); !well) return well;
    slottedAt_ = status_;
    if (auto sent = uploaded(loaded_->pictures); !sent) return sent;
    light_ = Light::slotted;  // even if the order fails: it may have got through
    return {};
}

Result<void> PluginStage::uploaded(const std::vector<Image<std::uint8_t>>& pictures) {
    int slot = 0;
    for (const auto& picture : pictures)
        if (auto sent = projector_->upload(slot++, picture); !sent) return known_.lost(sent.error());
    return {};
}

Result<void> PluginStage::swapped() {
    if (auto done = projector_->swap(++program_); !done) return known_.lost(done.error());
    return {};
}

Result<void> PluginStage::whiteInSlots(const PluginConfiguration& how) {
    auto done =
        uploaded(whiteSlots(projector_->description().raster, how.slots, how.bits)).and_then([&] { return swapped(); });
    if (done) light_ = Light::white;
    return done;
}

/// White in all slots, so that its pulses can be heard.
Result<void> PluginStage::slotsRun(const PluginConfiguration& how) {
    if (running_ == how) return {};
    light_ = Light::unknown;
    if (running_)
        if (auto stopped = projector_->stop(); !stopped) return known_.lost(stopped.error());
    running_.reset();
    if (auto timed = projector_->configure(how); !timed) return known_.wrong(timed.error());
    if (auto white = whiteInSlots(how); !white) return white;
    if (auto started = projector_->start(); !started) {
        light_ = Light::unknown;
        return known_.lost(started.error());
    }
    running_ = how;
    return {};
}

Result<void> PluginStage::confirmed() {
    return projectorWell().and_then([&] { return lens_.well(running_.has_value()); });
}

Result<void> PluginStage::projectorWell() {
    auto seen = projector_->status();
    if (!seen) return known_.lost(seen.error());
    known_.answered(projector_->name());
    status_ = *seen;
    const auto wrong = [&](std::string what) { return known_.wrong({Fault::device, std::move(what)}); };
    if (!seen->troubles.empty()) return wrong(seen->troubles.front());
    using State = PluginStatus::State;
    if (seen->state == State::dark || seen->state == State::unknown)
        return wrong(
            "The projector shows neither white nor slots; is it starting, parked or cooling? Wait, then TAKE.");
    if (running_ && seen->state != State::playing)
        return wrong("The projector stopped showing slots by itself; check its triggers and its power, then TAKE.");
    if (!running_ && seen->state == State::playing)
        return wrong("The projector shows slots although it was told steady white; close other programs that use it.");
    if (running_ && seen->program != program_) return wrong("The projector shows another program than it was told.");
    if (running_ && seen->slotRate > 0.0_Hz && std::abs(seen->slotRate / running_->slotRate - 1.0) > kMostOff)
        return wrong("The projector's slots come at " + inWords(seen->slotRate.si(), 2) + " Hz, not at the program's " +
                     inWords(running_->slotRate.si(), 2) + " Hz; set the rig's slot rate to what it can keep.");
    return light_ == Light::slotted ? countsWell(*seen) : Result<void>();
}

/// A slot that is not what it should be is wrong light in the middle of a sweep: none is let pass.
Result<void> PluginStage::countsWell(const PluginStatus& now) {
    const auto& before = *slottedAt_;
    const auto wrong = [&](std::string what) { return known_.wrong({Fault::device, std::move(what)}); };
    const auto times = [](std::uint64_t n, const std::string& thing) {
        return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
    };
    if (now.triggersLost > before.triggersLost)
        return wrong("The projector lost " + times(now.triggersLost - before.triggersLost, "trigger") +
                     "; check the trigger cable, then TAKE.");
    if (now.underruns > before.underruns)
        return wrong("The projector had no picture for a slot (" + times(now.underruns - before.underruns, "underrun") +
                     "); close what else keeps this machine busy, then TAKE.");
    if (now.dropped > before.dropped)
        return wrong("The projector dropped " + std::to_string(now.dropped - before.dropped) + " of " +
                     times(now.sent - before.sent, "frame") +
                     "; lower the rig's slot rate, or close what else keeps this machine busy, then TAKE.");
    return {};
}

/// Opens what is not open and makes it safe, so that all of it is known.
Result<void> PluginStage::reached(Dioptre rest) {
    if (auto rested = lens_.restsAt(rest); !rested) return rested;
    if (projector_ && lens_.there() && light_ != Light::unknown) return {};
    return reachedAgain();
}

Result<void> PluginStage::reachedAgain() {
    triedAt_ = rig_.clock.now();
    auto projector = openedProjector();
    auto lenses = lens_.opened();
    makeSafe();
    if (!projector) return projector;
    if (!lenses) return lenses;
    if (safeTrouble_) return tl::unexpected(*safeTrouble_);
    return {};
}

Result<void> PluginStage::openedProjector() {
    if (projector_) return {};
    auto opened = rig_.openProjector();
    if (!opened) return known_.lost(opened.error());
    projector_ = *std::move(opened);
    program_ = 0;
    known_.answered(projector_->name());
    return {};
}

Result<void> PluginStage::heartbeat() {
    if (projector_ && lens_.there()) {
        if (const auto well = confirmed(); !well) return faulted(well.error());
        return {};
    }
    if (!triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery) return reachedAgain();
    return fail(Fault::device, "Projector or lenses are not there; connect them, then TAKE.");
}

void PluginStage::safeLight() noexcept {
    try {
        const bool all = projector_ && lens_.there();
        const bool maySearch = !triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery;
        if (!all && maySearch)
            (void)reachedAgain();
        else if (all || !safeTold_)
            makeSafe();
    } catch (const std::exception&) {
        // Out of memory: what the devices do by themselves is left.
        light_ = Light::unknown;
    }
}

/// Light comes before the lens, since slots seen through a lens at rest are not what anybody planned; each is told even
/// if the other could not be, and once: what does not listen is let go.
void PluginStage::makeSafe() {
    safeTrouble_.reset();
    if (loaded_) loaded_->uploaded = false;
    running_.reset();
    status_.reset();
    if (projector_) {
        const auto white = projector_->steadyWhite();
        if (white) {
            light_ = Light::white;
        } else {
            safeTrouble_ = known_.lost(white.error()).value();
            projector_.reset();  // which asks for white once more, and lets go: whether it listened is not known
        }
    }
    if (!projector_ && light_ != Light::slotted) light_ = Light::unknown;
    const auto rested = lens_.rest();
    if (!rested && !safeTrouble_) safeTrouble_ = rested.error();
    safeTold_ = true;
}

tl::unexpected<Error> PluginStage::faulted(Error error) {
    loaded_.reset();
    safeLight();
    if (light_ != Light::white) error.what += " The projector's light is not known.";
    if (!lens_.resting()) error.what += " Where the lens is, is not known.";
    return tl::unexpected<Error>(std::move(error));
}

std::string PluginStage::projectorDoes() const {
    if (!projector_) return "no answer; its light is not known";
    if (light_ == Light::unknown) return "its light is not known";
    if (light_ == Light::white) return "steady white";
    std::string does = std::to_string(running_ ? running_->slots : 0) + " slots a sweep";
    if (running_) does += " at " + inWords(running_->slotRate.si(), 2) + " slots a second";
    return does;
}

StageReport PluginStage::report() const {
    StageReport report;
    report.simulated = false;
    report.light = light_ == Light::slotted ? LightMode::slotted : LightMode::steady;
    lens_.report(report, light_ == Light::slotted);
    report.well =
        projector_ && lens_.there() && light_ != Light::unknown && (report.lens != LensMode::rest || lens_.resting());
    report.projectorLine = known_.name() + ": " + projectorDoes();
    if (projector_ && !projector_->remark().empty()) report.projectorLine += "; " + projector_->remark();
    std::string shown = "It shows " + projectorDoes() + ".";
    if (status_ && light_ == Light::slotted)
        shown += " Of " + std::to_string(status_->sent - slottedAt_->sent) + " frames " +
                 std::to_string(status_->dropped - slottedAt_->dropped) + " were dropped.";
    report.devices = {known_.line(shown), lens_.line()};
    return report;
}

}  // namespace ilf::devices
