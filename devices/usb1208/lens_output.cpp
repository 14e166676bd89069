#include "devices/usb1208/lens_output.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

constexpr Milliseconds kControl{100};

}  // namespace

Second PlayedChange::wait() const {
    const auto frames = std::max<std::int64_t>(0, change.completeAt - heardFrom);
    return Second::fromSi(static_cast<double>(frames) / usb1208::kSampleRateHz);
}

LensOutput::LensOutput(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup, Clock clock)
    : link_(std::move(link)), setup_(setup), clock_(std::move(clock)) {}

Result<std::unique_ptr<LensOutput>> LensOutput::open(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup,
                                                     Clock clock) {
    for (const auto& [channel, name] :
         {std::pair(&setup.channels.left, "left lens"), std::pair(&setup.channels.right, "right lens")}) {
        if (auto good = checked(channel->amplifier, name); !good) return tl::unexpected(std::move(good.error()));
        if (!isFinite(channel->rest) || abs(channel->rest) > channel->amplifier.most)
            return fail(Fault::outOfRange, "The resting current of the " + std::string(name) +
                                               " is more than its amplifier may give. Correct it in the rig.");
    }
    std::unique_ptr<LensOutput> output(new LensOutput(std::move(link), setup, std::move(clock)));
    if (auto ready = output->opened(); !ready) return tl::unexpected(std::move(ready.error()));
    return output;
}

LensOutput::~LensOutput() { safe(); }

Result<void> LensOutput::opened() {
    if (auto rested = safe(); !rested) return rested;
    const auto read = readOutputs();
    const auto& [left, right] = setup_.channels;
    const auto step = [](const Amplifier& a) { return std::abs(usb1208::outputVolts(1).si() / a.dac.si()); };
    readsBack_ = read && std::abs((read->first - left.rest).si()) <= step(left.amplifier) &&
                 std::abs((read->second - right.rest).si()) <= step(right.amplifier);
    return {};
}

Result<void> LensOutput::usable() const {
    if (!fault_) return {};
    return fail(Fault::device,
                "The lenses are at rest after a fault of the DAC. Connect it again. The fault was: " + fault_->what);
}

Result<PlayedChange> LensOutput::play(const Waveform& left, const Waveform& right) {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    auto samples = sampled(setup_.channels, left, right);
    if (!samples) return tl::unexpected(std::move(samples.error()));
    std::size_t playing = 0;
    if (sweeping_) {
        const std::scoped_lock lock(mutex_);
        playing = player_->samples();
    }
    if (playing != 0 && playing != samples->size()) {
        if (auto rested = safe(); !rested) return faulted(rested.error());
        playing = 0;
    }
    if (playing == 0) {
        if (auto running = started(samples->size()); !running) return faulted(running.error());
    }
    PlayedChange played;
    played.heardFrom = static_cast<std::int64_t>(playedFrames());
    const std::scoped_lock lock(mutex_);
    auto change = player_->swap(*std::move(samples));
    if (!change) return tl::unexpected(std::move(change.error()));
    played.change = *change;
    return played;
}

Result<void> LensOutput::started(std::size_t samples) {
    const auto to = link_->bulkOut();
    if (!to) return tl::unexpected(to.error());
    auto clear = link_->controlOut(usb1208::kStopOutput, {}, kControl)
                     .and_then([&] { return link_->clearHalt(*to); })
                     .and_then([&] { return link_->controlOut(usb1208::kClearOutput, {}, kControl); });
    if (!clear) return clear;
    {
        const std::scoped_lock lock(mutex_);
        player_.emplace(setup_.channels, samples);
    }
    // The first transfers wait in the device before it starts, else it would start with an underrun.
    auto stream = link_->streamOut(*to, usb1208::kTransferFrames * usb1208::kBytesPerFrame, setup_.transfersInFlight,
                                   [this](std::span<std::uint8_t> frames) {
                                       const std::scoped_lock lock(mutex_);
                                       player_->fill(frames);
                                   });
    if (!stream) return tl::unexpected(std::move(stream.error()));
    stream_ = *std::move(stream);
    sweeping_ = true;
    streamRests_ = false;
    startedAt_ = clock_.now();
    return link_->controlOut(usb1208::kStartOutput, usb1208::outputScan(), kControl);
}

Result<void> LensOutput::slip(int samples) {
    if (auto ok = usable(); !ok) return ok;
    if (!sweeping_)
        return fail(Fault::unsupported, "The lenses are at rest: there is no sweep to slip. Start one first.");
    const std::scoped_lock lock(mutex_);
    player_->slip(samples);
    return {};
}

Result<Change> LensOutput::shift(int samples) {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    if (!sweeping_)
        return fail(Fault::unsupported, "The lenses are at rest: there is no sweep to shift. Start one first.");
    const std::scoped_lock lock(mutex_);
    return player_->shift(samples);
}

Result<LensOutputReport> LensOutput::heartbeat() {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    auto report = checkedNow();
    if (!report) return faulted(report.error());
    return report;
}

Result<LensOutputReport> LensOutput::checkedNow() {
    if (sweeping_) {
        if (auto state = stream_->state(); !state) {
            // A stalled endpoint is how the device says that it ran out of samples.
            const auto why =
                link_->controlIn(usb1208::kReadStatus, usb1208::kStatusBytes, kControl).and_then(usb1208::statusFrom);
            if (!why || !why->underrun) return tl::unexpected(state.error());
        }
    }
    const auto status =
        link_->controlIn(usb1208::kReadStatus, usb1208::kStatusBytes, kControl).and_then(usb1208::statusFrom);
    if (!status) return tl::unexpected(status.error());
    // At rest the bit may be left over from what ran before.
    if (sweeping_ && status->underrun)
        return fail(Fault::device,
                    "The DAC ran out of samples, so the lenses stood still for a moment: this computer was "
                    "too busy. Close other programs, or let more transfers wait (rig).");
    if (sweeping_ && !status->outputRuns)
        return fail(Fault::device, "The DAC has stopped sweeping the lenses by itself. Connect it again.");
    if (!sweeping_ && status->outputRuns)
        return fail(Fault::device,
                    "The DAC sweeps the lenses although it was told to hold them: another program may be "
                    "using it. Close that and connect it again.");
    LensOutputReport report;
    report.sweeping = sweeping_;
    report.readsBack = readsBack_;
    report.left = setup_.channels.left.rest;
    report.right = setup_.channels.right.rest;
    if (sweeping_) {
        const std::scoped_lock lock(mutex_);
        report.left = player_->lastLeft();
        report.right = player_->lastRight();
        report.frames = player_->frames();
    } else if (readsBack_) {
        const auto read = readOutputs();
        const Ampere step = Ampere::fromSi(2e-3);
        if (!read || abs(read->first - report.left) > step || abs(read->second - report.right) > step)
            return fail(Fault::device, "The DAC does not hold the resting currents it was told. Connect it again.");
    }
    return report;
}

std::optional<SweepPlayer::Place> LensOutput::placeOf(double frame) const {
    const std::scoped_lock lock(mutex_);
    return sweeping_ && player_ ? player_->placeOf(frame) : std::nullopt;
}

SweepPlayer::Tone LensOutput::leftTone() const {
    const std::scoped_lock lock(mutex_);
    return sweeping_ && player_ ? player_->leftTone() : SweepPlayer::Tone{};
}

int LensOutput::samplesPerSweep() const {
    const std::scoped_lock lock(mutex_);
    return sweeping_ && player_ ? static_cast<int>(player_->samples()) : 0;
}

double LensOutput::playedFrames() const {
    if (!sweeping_) return 0.0;
    return std::chrono::duration<double>(clock_.now() - startedAt_).count() * usb1208::kSampleRateHz;
}

}  // namespace ilf::devices
