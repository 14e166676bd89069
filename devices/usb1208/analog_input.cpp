#include "devices/usb1208/analog_input.h"

#include <utility>

namespace ilf::devices {
namespace {

constexpr Milliseconds kInputControl{100};
// 5 ms in whole 64-byte packets: what a phase decision waits for at most.
constexpr std::size_t kTransferBytes = 512;
constexpr int kInFlight = 8;
// Ten seconds: a recording for the rig is taken all the while, so this much means that nobody listens.
constexpr std::size_t kMostWaiting = std::size_t{10} * 48'000 * 2;

}  // namespace

AnalogInput::AnalogInput(std::shared_ptr<UsbLink> link, int channels, Clock clock)
    : link_(std::move(link)), channels_(channels), clock_(std::move(clock)) {}

Result<std::unique_ptr<AnalogInput>> AnalogInput::start(std::shared_ptr<UsbLink> link, Hearing hearing, Clock clock) {
    const int channels = hearing == Hearing::trigger ? 1 : 2;
    std::unique_ptr<AnalogInput> input(new AnalogInput(std::move(link), channels, std::move(clock)));
    if (auto running = input->started(); !running) return tl::unexpected(std::move(running.error()));
    return input;
}

AnalogInput::~AnalogInput() {
    // A single disturbance is no reason to let it run.
    if (!link_->controlOut(usb1208::kStopInput, {}, kInputControl))
        link_->controlOut(usb1208::kStopInput, {}, kInputControl);
    stream_.reset();
    link_->controlOut(usb1208::kClearInput, {}, kInputControl);
}

Result<void> AnalogInput::started() {
    const auto memory =
        link_->controlIn(usb1208::kReadInputCalibration, usb1208::kInputCalibrationBytes, kInputControl);
    if (memory) calibrations_ = usb1208::inputCalibrationsFrom(*memory);
    const auto from = link_->bulkIn();
    if (!from) return tl::unexpected(from.error());
    auto ready = link_->controlOut(usb1208::kStopInput, {}, kInputControl)
                     .and_then([&] { return link_->clearHalt(*from); })
                     .and_then([&] { return link_->controlOut(usb1208::kClearInput, {}, kInputControl); })
                     .and_then([&] {
                         return link_->controlOut(usb1208::kConfigureInput, usb1208::inputRanges(), kInputControl);
                     });
    if (!ready) return ready;
    auto stream = link_->streamIn(*from, kTransferBytes, kInFlight,
                                  [this](std::span<const std::uint8_t> data) { arrived(data); });
    if (!stream) return tl::unexpected(std::move(stream.error()));
    stream_ = *std::move(stream);
    const auto before = clock_.now();
    const auto mask = static_cast<std::uint8_t>(channels_ == 1 ? 0x01 : 0x03);
    auto running = link_->controlOut(usb1208::kStartInput, usb1208::inputScan(mask), kInputControl);
    startedAt_ = before + (clock_.now() - before) / 2;
    return running;
}

void AnalogInput::arrived(std::span<const std::uint8_t> data) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() + data.size() > kMostWaiting) {
        full_ = true;
        return;
    }
    waiting_.insert(waiting_.end(), data.begin(), data.end());
}

Result<HeardBlock> AnalogInput::take() {
    if (auto state = stream_->state(); !state) {
        const auto status =
            link_->controlIn(usb1208::kReadStatus, usb1208::kStatusBytes, kInputControl).and_then(usb1208::statusFrom);
        if (!status || !status->overrun) return tl::unexpected(std::move(state.error()));
        return fail(Fault::device,
                    "The DAC box lost samples of the trigger: this computer was too busy to fetch them. Close "
                    "other programs.");
    }
    std::vector<std::uint8_t> bytes;
    {
        const std::scoped_lock lock(mutex_);
        if (full_)
            return fail(Fault::device,
                        "Nobody listened to the DAC box for ten seconds, so the trigger's place is lost. "
                        "Connect it again.");
        const std::size_t one = 2 * static_cast<std::size_t>(channels_);
        const auto whole = static_cast<std::ptrdiff_t>(waiting_.size() / one * one);
        bytes.assign(waiting_.begin(), waiting_.begin() + whole);
        waiting_.erase(waiting_.begin(), waiting_.begin() + whole);
    }
    HeardBlock block;
    block.firstSample = taken_;
    const std::span<const std::uint8_t> view(bytes);
    for (std::size_t at = 0; at + 2 <= view.size();) {
        for (int channel = 0; channel < channels_; ++channel, at += 2) {
            const auto volts = usb1208::inputVolts(usb1208::sampleAt(view.subspan(at, 2)),
                                                   calibrations_.channels[static_cast<std::size_t>(channel)]);
            (channel == 0 ? block.trigger : block.second).push_back(volts.si());
        }
    }
    taken_ += static_cast<std::int64_t>(block.trigger.size());
    return block;
}

}  // namespace ilf::devices
