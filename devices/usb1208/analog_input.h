// What the DAC box hears: the projector's trigger, and a photodiode or an echo of the left lens's output.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/result.h"
#include "devices/clock.h"
#include "devices/usb/usb_link.h"
#include "devices/usb1208/messages.h"

namespace ilf::devices {

/// AI0: TRIG_OUT_2 of the projector. AI1: the photodiode while a rig is measured, else a wire from AO0, which says
/// where in its sweep the left output stands.
enum class Hearing {
    trigger,        ///< 48000 samples a second
    triggerAndAI1,  ///< 24000 of each; AI1's are half a sample later
};

/// Samples that have not been taken before, in volts.
struct HeardBlock {
    std::int64_t firstSample = 0;  ///< of each channel, since the start
    std::vector<double> trigger, second;
};

/// Calls come from one thread; samples arrive on the stream's own. Inputs and outputs presumably count by the same 60
/// MHz oscillator; that is unverified, and `SweepSync` notices where it is not so.
class AnalogInput {
public:
    /// Reads the factory calibration, then starts. Without a calibration that makes sense, codes are nominal.
    static Result<std::unique_ptr<AnalogInput>> start(std::shared_ptr<UsbLink> link, Hearing hearing,
                                                      Clock clock = Clock::steady());
    ~AnalogInput();
    AnalogInput(const AnalogInput&) = delete;
    AnalogInput& operator=(const AnalogInput&) = delete;

    /// Errors: the stream ended, the device lost samples (overrun) or nobody took any for ten seconds.
    Result<HeardBlock> take();
    bool factoryCalibrated() const { return calibrations_.factory; }
    /// For each channel.
    double samplesPerSecond() const { return usb1208::kSampleRateHz / channels_; }
    int channels() const { return channels_; }
    /// When the first sample was taken, to the length of one USB request (about 1 ms).
    std::chrono::nanoseconds startedAt() const { return startedAt_; }

private:
    AnalogInput(std::shared_ptr<UsbLink> link, int channels, Clock clock);
    Result<void> started();
    void arrived(std::span<const std::uint8_t> data);

    std::shared_ptr<UsbLink> link_;
    int channels_;
    Clock clock_;
    usb1208::InputCalibrations calibrations_;
    std::chrono::nanoseconds startedAt_{0};
    std::mutex mutex_;                   ///< guards what follows
    std::vector<std::uint8_t> waiting_;  ///< whole samples of all channels, and at the end perhaps half of one
    bool full_ = false;
    std::int64_t taken_ = 0;             ///< samples of each channel
    std::unique_ptr<UsbStream> stream_;  ///< last: it ends before what it fills
};

}  // namespace ilf::devices
