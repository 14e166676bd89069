#include "devices/usb1208/sweep_sync.h"

#include <cmath>
#include <numbers>

namespace ilf::devices {
namespace {

// Whole sweeps over which an echo is averaged: 0.2 s at 60 Hz.
constexpr double kEchoSweeps = 12.0;
// An echo below this is no wire, or a lens that stands still.
constexpr double kLeastEchoVolts = 0.02;
// The echo's noise moves its phase by hundredths of a sample; lost samples move it by at least one.
constexpr double kMostMoved = 1.5;
// By how much the reckoned place may be off before it is heard: 50 ms.
constexpr double kUnsureFrames = 2400.0;
constexpr std::chrono::milliseconds kSilence{300};

}  // namespace

SweepSync::SweepSync(LensOutput& output, AnalogInput& input, Echo echo, EdgeLevels levels, double target, Clock clock)
    : output_(output), input_(input), echo_(echo), finder_(levels),
      lock_(PhaseLockSetup{.samplesPerSweep = output.samplesPerSweep(), .target = target}), clock_(std::move(clock)),
      framesPerSample_(usb1208::kSampleRateHz / input.samplesPerSecond()),
      origin_(std::chrono::duration<double>(input.startedAt() - output.startedAt()).count() * usb1208::kSampleRateHz),
      lastHeard_(clock_.now()) {}

Result<SyncReport> SweepSync::step() {
    const auto block = input_.take();
    if (!block) return tl::unexpected(block.error());
    if (!block->trigger.empty()) lastHeard_ = clock_.now();
    if (clock_.now() - lastHeard_ > kSilence)
        return fail(Fault::device, "The DAC box has stopped listening to the trigger. Connect it again.");
    if (waitingShift_ != 0 && output_.shift(waitingShift_)) waitingShift_ = 0;
    if (echo_ == Echo::leftOutput) {
        if (auto well = heardEcho(*block); !well) return tl::unexpected(std::move(well.error()));
    }
    const auto edges = finder_.found(block->trigger);
    const auto heardUntil = static_cast<double>(block->firstSample) + static_cast<double>(block->trigger.size());
    // Until the echo has told where the sweep is, edges would be judged against a guess.
    if (echo_ == Echo::none || placeKnown_) {
        for (const double edge : edges) {
            if (auto done = followed(origin_ + edge * framesPerSample_); !done) return tl::unexpected(done.error());
        }
        if (auto there = lock_.heard(origin_ + heardUntil * framesPerSample_); !there)
            return tl::unexpected(std::move(there.error()));
    }
    return SyncReport{lock_.report(), placeKnown_};
}

Result<void> SweepSync::followed(double frame) {
    const auto place = output_.placeOf(frame);
    if (!place) return {};  // before the first sweep
    const auto advice = lock_.edge(frame, place->offset, place->moved);
    if (!advice) return tl::unexpected(advice.error());
    switch (advice->kind) {
    case PhaseAdvice::Kind::none:
        return {};
    case PhaseAdvice::Kind::slip:
        return output_.slip(advice->samples);
    case PhaseAdvice::Kind::align:
        // A wave that is just changing is moved once it has changed.
        if (!output_.shift(advice->samples)) waitingShift_ = advice->samples;
        return {};
    }
    return {};
}

/// The fundamental of what is heard, against that of what was sent, says how far the reckoned place is off.
Result<void> SweepSync::heardEcho(const HeardBlock& block) {
    const auto tone = output_.leftTone();
    const double sweep = output_.samplesPerSweep();
    if (std::abs(tone.fundamental) < kLeastEchoVolts || sweep <= 0.0) {
        sum_ = echoSamples_ = 0.0;
        return {};
    }
    for (std::size_t i = 0; i < block.second.size(); ++i) {
        // AI1 is converted one frame after AI0.
        const double sample = static_cast<double>(block.firstSample) + static_cast<double>(i);
        const double frame = origin_ + sample * framesPerSample_ + 1.0;
        // What was told just now is not heard yet.
        const auto place = output_.placeOf(frame);
        if (!place || frame < static_cast<double>(tone.since) + kUnsureFrames) {
            sum_ = echoSamples_ = 0.0;
            continue;
        }
        sum_ += block.second[i] * std::polar(1.0, -2.0 * std::numbers::pi * place->offset / sweep);
        echoSamples_ += 1.0;
        if (echoSamples_ * framesPerSample_ < kEchoSweeps * sweep) continue;
        const auto heard = 2.0 / echoSamples_ * sum_;
        sum_ = echoSamples_ = 0.0;
        if (std::abs(heard) < 0.5 * std::abs(tone.fundamental))
            return fail(Fault::device,
                        "The DAC box does not hear the left lens's wave on its second input. Check the wire "
                        "from AO0 to AI1.");
        const double off = std::arg(heard / tone.fundamental) * sweep / (2.0 * std::numbers::pi);
        if (!placeKnown_) {
            origin_ += off;
            placeKnown_ = true;
        } else if (std::abs(off) > kMostMoved) {
            return fail(Fault::device,
                        "The left lens's wave is not where it should be in its sweep: the DAC lost samples, "
                        "or its inputs and outputs do not count alike. Connect it again.");
        }
    }
    return {};
}

}  // namespace ilf::devices
