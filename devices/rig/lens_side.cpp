#include "devices/rig/lens_side.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/as_text.h"
#include "core/plan/words.h"
#include "devices/simulated/simulated_stage.h"  // the budgets, which are the same

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kListenEvery = 20ms;
// Fitting takes 0.4 s, aligning and settling as long again; an echo is heard in half a second.
constexpr std::chrono::nanoseconds kLongestLocking = 5s;
// The phase's worst error covers two seconds, at first those in which it was being aligned.
constexpr std::chrono::nanoseconds kPhaseMemory = 2100ms;

}  // namespace

Result<void> LensSide::restsAt(Dioptre rest) {
    if (lens_ && lens_->rest() != rest) {
        auto rested = lens_->safe();
        lens_.reset();
        told_.reset();
        resting_ = rested.has_value();
        if (!rested) return known_.lost(rested.error());
    }
    rest_ = rest;
    return {};
}

Result<void> LensSide::opened() {
    if (lens_) return {};
    auto opened = open_(rest_);
    if (!opened) return known_.lost(opened.error());
    lens_ = *std::move(opened);
    known_.answered(lens_->name());
    return {};
}

Result<void> LensSide::settled(const Waveform& wave, Second triggerAhead) {
    if (!plays(wave, triggerAhead)) {
        resting_ = false;
        told_ = wave;  // whatever becomes of the order
        ahead_ = triggerAhead;
        const auto alone = lens_->play(wave, triggerAhead);
        if (!alone) return failed(alone.error());
        wait(inNs(*alone));
        const std::int64_t now = clock_.now().count();
        predicted_ = predicted_.told(wave, now);
        settling_ = Second::fromSi(static_cast<double>(predicted_.settledNs(kSettledLens) - now) * 1e-9);
        phase_.reset();
    }
    wait(std::chrono::nanoseconds(predicted_.settledNs(kSettledLens)) - clock_.now());
    return {};
}

Result<void> LensSide::inStep() {
    if (told_->still()) return {};
    const auto begun = clock_.now();
    auto unlocked = begun;
    while (true) {
        const auto phase = lens_->follow();
        if (!phase) return failed(phase.error());
        phase_ = *phase;
        const auto now = clock_.now();
        if (!phase->locked) unlocked = now;
        if (phase->locked && now - unlocked > inNs(settling_)) break;
        if (now - begun > kLongestLocking)
            return known_.wrong(
                {Fault::device, "The lens's sweep does not lock to the projector's triggers; check the cable from " +
                                    triggers_ + " to the DAC box, and the echo's wire."});
        wait(kListenEvery);
    }
    lockedSince_ = clock_.now();
    missingBefore_ = phase_->missing;
    return {};
}

Result<void> LensSide::well(bool triggersCome) {
    const auto condition = lens_->heartbeat();
    if (!condition) return failed(condition.error());
    known_.answered(lens_->name());
    if (condition->sweeping != told_.has_value())
        return known_.wrong(
            {Fault::device, "The lens does something else than it was told; was its driver restarted?"});
    temperature_C_ = condition->temperature_C;
    if (auto fine = atItsTemperature(); !fine) return fine;
    if (!triggersCome || !told_ || told_->still()) return {};
    const auto phase = lens_->follow();
    if (!phase) return failed(phase.error());
    phase_ = *phase;
    if (!phase->locked)
        return known_.wrong({Fault::device, "The lens's sweep has lost the projector's triggers; check the trigger "
                                            "cable, then TAKE."});
    if (clock_.now() - lockedSince_ < kPhaseMemory || phase->most <= kPhaseBudget) return {};
    return known_.wrong({Fault::device, "Slots and lens were " + asText("%.2f ms", phase->most.in(1.0_ms)) +
                                            " apart; check the trigger cable, then TAKE."});
}

Result<void> LensSide::atItsTemperature() {
    if (!told_ || !temperature_C_) return {};
    const double planned_C =
        std::clamp(*temperature_C_, told_->temperature_C, told_->temperature_C + std::max(0.0, told_->warming_C));
    if (std::abs(*temperature_C_ - planned_C) <= kTemperatureBudget_C) return {};
    return known_.wrong({Fault::device, "The lens is at " + asText("%.1f C", *temperature_C_) +
                                            ", too far from what its wave was planned for; let it come back, or plan "
                                            "again at this temperature."});
}

Result<void> LensSide::rest() {
    Result<void> rested;
    if (lens_) {
        rested = lens_->safe();
        resting_ = rested.has_value();
        if (!rested) rested = known_.lost(rested.error());
    }
    // Lenses that were let go at rest stay there.
    if (!resting_ || std::exchange(failed_, false)) lens_.reset();
    failed_ = false;
    if (resting_) predicted_ = predicted_.told(stillWave(rest_, rest_, 60.0_Hz), clock_.now().count());
    told_.reset();
    phase_.reset();
    return rested;
}

tl::unexpected<Error> LensSide::failed(const Error& error) {
    failed_ = true;
    return known_.lost(error);
}

void LensSide::wait(std::chrono::nanoseconds time) {
    if (time > 0ns) clock_.wait(time);
}

std::string LensSide::phaseWords() const {
    if (!phase_) return "";
    return asText("; phase within %.0f us", phase_->most.in(1.0_us)) + asText(", %+.0f ppm", phase_->driftPpm);
}

void LensSide::report(StageReport& into, bool slotted) const {
    into.lens = !told_ ? LensMode::rest : told_->still() ? LensMode::holding : LensMode::sweeping;
    into.lensPower = into.low = into.high = rest_;
    if (told_) {
        into.low = told_->low;
        into.high = told_->high;
        into.lensPower = told_->still() ? told_->low : predicted_.powerAt(clock_.now().count());
    }
    if (slotted && phase_)
        into.timing =
            StageTiming{phase_->locked, phase_->most, phase_->jitter, phase_->driftPpm,
                        static_cast<std::uint64_t>(std::max<std::int64_t>(0, phase_->missing - missingBefore_))};
    if (lens_) into.lensTemperature_C = temperature_C_;
    into.lensName = lens_ ? known_.name() : "lenses";
    if (!lens_)
        into.lensLine = resting_ ? "lenses: at rest after a fault, to be opened again"
                                 : "lenses: no answer; where they are is not known";
    else if (!told_)
        into.lensLine = known_.name() + asText(": at rest at %.2f D", rest_.si());
    else
        into.lensLine = known_.name() + asText(": told %.2f", told_->low.si()) +
                        asText(" to %.2f D", told_->high.si()) + phaseWords() +
                        (temperature_C_ ? "" : "; its temperature is not known");
}

DeviceLine LensSide::line() const {
    if (!told_) return known_.line("They rest at " + ilf::inWords(rest_) + "; TAKE plays the sweep.");
    const std::string does =
        told_->still() ? "They hold " + ilf::inWords(told_->low)
                       : "They sweep " + ilf::inWords(told_->low.si(), 2) + " to " + ilf::inWords(told_->high);
    // Without a sensor nothing can be trimmed to it.
    return known_.line(does + phaseWords() +
                       (temperature_C_ ? ", at " + ilf::inWords(*temperature_C_, 1) + " degrees C."
                                       : "; their temperature is not measured, so what warming coils do to their "
                                         "powers is not made up for."));
}

}  // namespace ilf::devices
