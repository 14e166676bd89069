// Whether the devices do what they were told, and what is done when they do not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "devices/rig/lightcrafter_stage.h"
#include "devices/simulated/simulated_stage.h"  // the budgets, which are the same

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kTryEvery = 1s;
// The phase's worst error covers two seconds, at first those in which it was being aligned.
constexpr std::chrono::nanoseconds kPhaseMemory = 2100ms;

std::string number(const char* format, double value) {
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

}  // namespace

Result<void> LightCrafterStage::videoWell() {
    const auto mode = rig_.video->mode();
    if (!mode) return tl::unexpected(mode.error());
    if (!white_.empty() && mode->size != white_.size())
        return fail(Fault::device, "The projector's display was switched to another mode; set 912x1140, then TAKE.");
    mode_ = *mode;
    return {};
}

Result<void> LightCrafterStage::projectorWell() {
    const auto seen = projector_->watch();
    if (!seen) return tl::unexpected(seen.error());
    if (!seen->troubles.empty()) return fail(Fault::device, seen->troubles.front());
    if (running_ && !seen->playing)
        return fail(Fault::device, "The projector stopped showing patterns by itself; check its video, then TAKE.");
    if (!running_ && (seen->display != dlpc350::Display::video || seen->run == dlpc350::PatternRun::running))
        return fail(Fault::device, "The projector shows patterns although it was told plain video; close other "
                                   "programs that use it.");
    return {};
}

Result<void> LightCrafterStage::lensWell() {
    const auto condition = lens_->heartbeat();
    if (!condition) return lensFailed(condition.error());
    if (condition->sweeping != told_.has_value())
        return fail(Fault::device, "The lens does something else than it was told; was its driver restarted?");
    temperature_C_ = condition->temperature_C;
    if (!told_ || !temperature_C_) return {};
    const double planned_C =
        std::clamp(*temperature_C_, told_->temperature_C, told_->temperature_C + std::max(0.0, told_->warming_C));
    if (std::abs(*temperature_C_ - planned_C) <= kTemperatureBudget_C) return {};
    return fail(Fault::device, "The lens is at " + number("%.1f C", *temperature_C_) +
                                   ", too far from what its wave was planned for; let it come back, or plan again at "
                                   "this temperature.");
}

Result<void> LightCrafterStage::phaseWell() {
    if (!running_ || !told_ || told_->still()) return {};
    const auto phase = lens_->follow();
    if (!phase) return lensFailed(phase.error());
    phase_ = *phase;
    if (!phase->locked)
        return fail(Fault::device,
                    "The lens's sweep has lost the projector's triggers; check the trigger cable, then TAKE.");
    if (rig_.clock.now() - lockedSince_ < kPhaseMemory || phase->most <= kPhaseBudget) return {};
    return fail(Fault::device, "Slots and lens were " + number("%.2f ms", phase->most.in(1.0_ms)) +
                                   " apart; check the trigger cable, then TAKE.");
}

Result<void> LightCrafterStage::confirmed() {
    return videoWell().and_then([&] { return projectorWell(); }).and_then([&] { return lensWell(); }).and_then([&] {
        return phaseWell();
    });
}

/// Opens what is not open and makes it safe, so that all of it is known; lenses that rest elsewhere are opened anew.
Result<void> LightCrafterStage::reached(Dioptre rest) {
    if (lens_ && lens_->rest() != rest) {
        auto rested = lens_->safe();
        lens_.reset();
        told_.reset();
        if (!rested) return rested;
    }
    rest_ = rest;
    if (projector_ && lens_ && light_ != Light::unknown) return {};
    return reachedAgain();
}

Result<void> LightCrafterStage::reachedAgain() {
    triedAt_ = rig_.clock.now();
    std::optional<Error> first;
    const auto note = [&](const Error& error) {
        if (!first) first = error;
    };
    if (!projector_) {
        auto opened = rig_.openProjector();
        if (opened)
            projector_ = *std::move(opened);
        else
            note(opened.error());
    }
    if (!lens_) {
        auto opened = rig_.openLens(rest_);
        if (opened)
            lens_ = *std::move(opened);
        else
            note(opened.error());
    }
    if (const auto mode = rig_.video->mode()) {
        mode_ = *mode;
        white_ = uniformFrame(mode->size, 255);
        videoThere_ = true;
    } else {
        note(mode.error());
    }
    makeSafe();
    if (!first) first = safeTrouble_;
    if (first) return tl::unexpected(*first);
    return {};
}

Result<void> LightCrafterStage::heartbeat() {
    if (projector_ && lens_ && videoThere_) {
        if (const auto well = confirmed(); !well) return faulted(well.error());
        return {};
    }
    if (!triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery) return reachedAgain();
    return fail(Fault::device, "Projector, display or lenses are not there; connect them, then TAKE.");
}

void LightCrafterStage::safeLight() noexcept {
    try {
        const bool all = projector_ && lens_ && videoThere_;
        const bool maySearch = !triedAt_ || rig_.clock.now() - *triedAt_ >= kTryEvery;
        if (!all && maySearch)
            (void)reachedAgain();
        else if (all || !safeTold_)
            makeSafe();
    } catch (const std::exception&) {
        // Out of memory: what the devices do by themselves is left.
        light_ = Light::unknown;
        resting_ = false;
    }
}

/// Light comes before the lens, since slots seen through a lens at rest are not what anybody planned; each is told even
/// if the one before could not be, and once: what does not listen is let go.
void LightCrafterStage::makeSafe() {
    safeTrouble_.reset();
    const auto listened = [&](const auto& told) {
        if (!told && !safeTrouble_) safeTrouble_ = told.error();
        return told.has_value();
    };
    // White video is uniform light in patterns too, so that it holds even if the board does not listen.
    const bool white = videoThere_ && !white_.empty() && listened(rig_.video->show(white_));
    videoThere_ = white;
    if (projector_ && !listened(projector_->showVideo())) projector_.reset();
    const bool slotsMayBeOn = light_ == Light::slotted && !white && !projector_;
    light_ = white && projector_ ? Light::white : slotsMayBeOn ? Light::slotted : Light::unknown;
    running_.reset();

    // Lenses that were let go at rest stay there.
    if (lens_) resting_ = listened(lens_->safe());
    if (!resting_) lens_.reset();
    if (std::exchange(lensFailed_, false)) lens_.reset();
    if (resting_) predicted_ = predicted_.told(stillWave(rest_, rest_, 60.0_Hz), rig_.clock.now().count());
    told_.reset();
    phase_.reset();
    safeTold_ = true;
}

tl::unexpected<Error> LightCrafterStage::lensFailed(const Error& error) {
    lensFailed_ = true;
    return tl::unexpected<Error>(error);
}

tl::unexpected<Error> LightCrafterStage::faulted(Error error) {
    safeLight();
    if (light_ != Light::white) error.what += " The projector's light is not known.";
    if (!resting_) error.what += " Where the lens is, is not known.";
    return tl::unexpected<Error>(std::move(error));
}

StageReport LightCrafterStage::report() const {
    StageReport report;
    report.simulated = false;
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

    const std::string board = projector_ ? projector_->name() : "LightCrafter 4500";
    if (!projector_)
        report.projectorLine =
            board + ": no answer" + (videoThere_ ? ", it is sent white; " : "; ") + "its light is not known";
    else if (!videoThere_)
        report.projectorLine =
            board + ": its display " + rig_.video->display().connector + " is gone; its light is not known";
    else if (light_ == Light::slotted)
        report.projectorLine = board + ": " + std::to_string(running_ ? running_->entries.size() : 0) + " slots at " +
                               number("%.2f Hz", mode_.refresh.si());
    else
        report.projectorLine = board + (light_ == Light::white ? ": steady white" : ": its light is not known");

    report.lensName = lens_ ? lens_->name() : "lenses";
    if (!lens_)
        report.lensLine = resting_ ? "lenses: at rest after a fault, to be opened again"
                                   : "lenses: no answer; where they are is not known";
    else if (!told_)
        report.lensLine = report.lensName + number(": at rest at %.2f D", rest_.si());
    else
        report.lensLine =
            report.lensName + number(": told %.2f", report.low.si()) + number(" to %.2f D", report.high.si());
    if (lens_ && told_ && phase_)
        report.lensLine +=
            number("; phase within %.0f us", phase_->most.in(1.0_us)) + number(", %+.0f ppm", phase_->driftPpm);
    if (lens_ && told_ && !temperature_C_) report.lensLine += "; its temperature is not known";
    return report;
}

}  // namespace ilf::devices
