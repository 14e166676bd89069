// How lenses on the DAC come to rest, whatever happened before.
#include <utility>

#include "devices/lens_driver/limits.h"
#include "devices/usb1208/lens_output.h"
#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

// On the way to rest a device that hangs may cost no more than this for each request.
constexpr Milliseconds kControlAtRest{20};
// 40 ms of steps: with the requests' own time inside 100 ms.
constexpr int kSteps = 8;
constexpr Milliseconds kStep{5};
// As long, in samples.
constexpr std::int64_t kRampFrames = 1920;
// A transfer is taken every 10 ms; after this long without one, on a computer that is busy, none will be.
constexpr Milliseconds kNoneTaken{250};

}  // namespace

tl::unexpected<Error> LensOutput::faulted(Error error) {
    if (!fault_) {
        fault_ = error;
        safe();
    }
    return tl::unexpected(std::move(error));
}

Result<void> LensOutput::safe() {
    // Playing out what is buffered would take 80 ms before the first step: the scan is cut off, and the ramp goes by
    // single writes. A cut stops the lens where it is, which is no steeper than any sweep.
    const auto stop = stopped();
    if (streamRests_) return {};
    const auto& [left, right] = setup_.channels;
    const auto from = readOutputs().value_or(told_.value_or(std::pair(left.rest, right.rest)));
    Result<void> last;
    bool told = false;
    for (int step = from == std::pair(left.rest, right.rest) ? kSteps : 1; step <= kSteps; ++step) {
        const double share = static_cast<double>(step) / kSteps;
        last = held(from.first + share * (left.rest - from.first), from.second + share * (right.rest - from.second));
        told = told || last;
        if (!last && !told) break;
        if (step < kSteps) clock_.wait(kStep);
    }
    return last ? stop : last;
}

Result<void> LensOutput::stopped() {
    // A single disturbance is no reason to let it run.
    auto stop = link_->controlOut(usb1208::kStopOutput, {}, kControlAtRest);
    if (!stop) stop = link_->controlOut(usb1208::kStopOutput, {}, kControlAtRest);
    streamRests_ = !stop && (streamRests_ || restedByStream());
    stream_.reset();
    sweeping_ = false;
    {
        const std::scoped_lock lock(mutex_);
        if (player_) told_.emplace(player_->lastLeft(), player_->lastRight());
        player_.reset();
    }
    if (streamRests_) return stop;
    // What was cut off must not be played when the next scan starts; that start clears again, so an error waits for it.
    link_->controlOut(usb1208::kClearOutput, {}, kControlAtRest);
    return stop;
}

/// Requests and samples go to different endpoints: a device that refuses to be stopped plays what it is sent all the
/// same. Once the stream ends it holds its last sample, so it rests as soon as all it can still hold is rest: what was
/// made, but for what is in flight, is in the device, and what is in the device, but for its buffer, was played.
bool LensOutput::restedByStream() {
    if (!stream_) return false;
    const auto behind = static_cast<std::int64_t>(usb1208::kTransferFrames) * setup_.transfersInFlight +
                        static_cast<std::int64_t>(usb1208::kOutputFifoBytes / usb1208::kBytesPerFrame);
    std::int64_t made = -1;
    for (auto taken = clock_.now(); clock_.now() - taken < kNoneTaken; clock_.wait(kStep)) {
        if (!stream_->state()) return false;
        const std::scoped_lock lock(mutex_);
        player_->rest(kRampFrames);
        const auto rests = player_->restsSince();
        if (rests && player_->frames() - *rests >= behind) return true;
        if (std::exchange(made, player_->frames()) != player_->frames()) taken = clock_.now();
    }
    return false;
}

Result<void> LensOutput::held(Ampere left, Ampere right) {
    const auto write = [&](int channel, const Amplifier& amplifier, Ampere current) {
        const Ampere safe = clamped(current, {-amplifier.most, amplifier.most});
        const auto code = usb1208::outputCode(voltsFor(amplifier, safe));
        const auto request = usb1208::setOutput(channel, code);
        auto done = link_->controlOut(request, {}, kControlAtRest);
        if (!done) done = link_->controlOut(request, {}, kControlAtRest);
        return done;
    };
    // The other lens is told whatever became of the one.
    auto one = write(0, setup_.channels.left.amplifier, left);
    auto other = write(1, setup_.channels.right.amplifier, right);
    told_.emplace(left, right);
    return one ? other : one;
}

std::optional<std::pair<Ampere, Ampere>> LensOutput::readOutputs() {
    const auto codes = link_->controlIn(usb1208::kReadOutputs, usb1208::kReadOutputsBytes, kControlAtRest)
                           .and_then(usb1208::outputsFrom);
    if (!codes || (*codes)[0] >= usb1208::kCodes || (*codes)[1] >= usb1208::kCodes) return std::nullopt;
    const auto& [left, right] = setup_.channels;
    return std::pair(currentAt(left.amplifier, usb1208::outputVolts((*codes)[0])),
                     currentAt(right.amplifier, usb1208::outputVolts((*codes)[1])));
}

}  // namespace ilf::devices
