#include "devices/rig/usb1208_lens.h"

#include "devices/usb1208/messages.h"

namespace ilf::devices {

Usb1208Lens::Usb1208Lens(std::shared_ptr<UsbLink> link, std::unique_ptr<LensOutput> output, Dioptre rest, Clock clock,
                         EdgeLevels levels)
    : link_(std::move(link)), rest_(rest), clock_(std::move(clock)), levels_(levels), output_(std::move(output)) {}

Result<std::unique_ptr<StageLens>> Usb1208Lens::open(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup,
                                                     Dioptre rest, Clock clock, EdgeLevels levels) {
    auto output = LensOutput::open(link, setup, clock);
    if (!output) return tl::unexpected(output.error());
    return std::unique_ptr<StageLens>(
        new Usb1208Lens(std::move(link), *std::move(output), rest, std::move(clock), levels));
}

Result<Second> Usb1208Lens::play(const Waveform& wave, Second triggerAhead) {
    const auto played = output_->play(wave, wave);
    if (!played) return tl::unexpected(played.error());
    // The wave, its delay or its scan is another one: heard anew.
    sync_.reset();
    input_.reset();
    target_ = -triggerAhead.si() * usb1208::kSampleRateHz;
    return played->wait();
}

Result<void> Usb1208Lens::listening() {
    if (sync_) return {};
    auto input = AnalogInput::start(link_, Hearing::triggerAndAI1, clock_);
    if (!input) return tl::unexpected(input.error());
    input_ = *std::move(input);
    sync_.emplace(*output_, *input_, Echo::leftOutput, levels_, target_, clock_);
    return {};
}

Result<PhaseState> Usb1208Lens::follow() {
    if (auto heard = listening(); !heard) return tl::unexpected(heard.error());
    const auto step = sync_->step();
    if (!step) return tl::unexpected(step.error());
    const PhaseReport& phase = step->phase;
    return PhaseState{phase.locked && step->placeKnown, phase.most, phase.driftPpm, phase.missing, phase.jitter};
}

Result<LensCondition> Usb1208Lens::heartbeat() {
    const auto report = output_->heartbeat();
    if (!report) return tl::unexpected(report.error());
    return LensCondition{report->sweeping, std::nullopt};
}

Result<void> Usb1208Lens::safe() {
    auto rested = output_->safe();  // first: a box that is silent makes what follows last
    sync_.reset();
    input_.reset();
    return rested;
}

}  // namespace ilf::devices
