// A LightCrafter 4500 (TI DLPC350) that nobody has to own: USB packets and video frames in, packets and light out.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "devices/emulators/bit_planes.h"
#include "devices/emulators/fault.h"
#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

/// Where devices.md reports what users meet, or where its sources differ (1.4, 1.7, 1.9).
struct LightCrafterQuirks {
    bool secondStart = true;       ///< the first start after a change of the LUT is ignored; one 50 ms later is not
    bool swapsWithoutBit = false;  ///< the first entry of a sequence swaps buffers even without its bit
    int togglesUntilHang = 25;     ///< switches from pattern to video with a source plugged; 0: never hangs
    std::uint8_t triggerPolarityBit = 0x02;  ///< of TRIG_OUT_1 and 2; others say 0x01
    bool plugSelectsVideo = true;            ///< a source that appears is shown instead of a picture of the board's own
};

struct LightCrafterOptions {
    LightCrafterQuirks quirks;
    std::array<std::uint8_t, 4> firmware = {4, 4, 0, 0};  ///< major, minor, patch high, patch low
    std::uint8_t endpoint = 1;                            ///< of its two interrupt endpoints
    std::int64_t modeSwitch_ns = 60'000'000;  ///< until a new display mode is read back (TI polls every 100 ms)
    std::int64_t validation_ns = 20'000'000;  ///< until the LUT is checked
    std::int64_t lock_ns = 200'000'000;       ///< until a source that was plugged is locked
    std::int64_t triggerWidth_ns = 100'000;   ///< of TRIG_OUT_2; not documented where we read
    int framesAwaited = 6;                    ///< how many may be late until there is no video any more (`knownUntil`)
};

/// What is plugged into the video input. Frames come one a period, each at its vertical sync.
struct VideoSource {
    int width = 912, height = 1140;
    double refresh_Hz = 59.94;
    bool operator==(const VideoSource&) const = default;
};

/// A rising or falling edge of TRIG_OUT_2.
struct TriggerEdge {
    std::int64_t time_ns = 0;
    bool high = false;
    bool operator==(const TriggerEdge&) const = default;
};

/// Written from the public protocol as devices.md 1 retells it, without the driver's help, and never compared with a
/// projector. What the sources leave open is decided strictly, so that a careless host notices: changing the LUT, mode
/// or timing while the sequence runs, starting an unchecked LUT or starting in video mode is answered with a NACK.
/// Light is handed over once (`takeLight`), the last 8192 slots of it; it is cheap until its pixels are asked for.
class EmulatedLightCrafter final : public EmulatedUsbDevice {
public:
    explicit EmulatedLightCrafter(LightCrafterOptions options = {});

    UsbDescriptors descriptors() const override;
    UsbTransfer out(std::uint8_t endpoint, std::span<const std::uint8_t> data, std::int64_t now_ns) override;
    UsbTransfer in(std::uint8_t endpoint, std::span<std::uint8_t> room, std::int64_t now_ns) override;
    UsbTransfer control(const ControlSetup& setup, std::span<std::uint8_t> data, std::int64_t now_ns) override;
    void clearHalt(std::uint8_t endpoint, std::int64_t now_ns) override;
    void unplugged(std::int64_t now_ns) override;
    std::optional<std::int64_t> backOnBusAt() const override { return backOnBus_ns_; }

    /// The board's helper switches to video when a source appears (devices.md 1.9).
    void plugVideo(const VideoSource& source, std::int64_t now_ns);
    void unplugVideo(std::int64_t now_ns);
    /// A vertical sync: the frame before this one is complete, and `frame` begins to come in. It is shown from the next
    /// one on (devices.md 1.8). Frames without a source plugged are not seen.
    void verticalSync(FramePtr frame, std::int64_t now_ns);
    /// An edge on TRIG_IN_1, for trigger modes 1 and 3.
    void triggerIn(std::int64_t now_ns);
    /// All settings are volatile: as it comes from the shelf, its source still plugged.
    void powerCycle(std::int64_t now_ns);
    void setFaults(const std::vector<DeviceFault>& faults) { faults_ = FaultPlan(faults); }

    /// The exposures that ended by `now_ns`, oldest first; in video mode one for each frame.
    std::vector<LightSlot> takeLight(std::int64_t now_ns);
    /// TRIG_OUT_2, in order. A forgetful host loses the oldest beyond 4096.
    std::vector<TriggerEdge> takeTriggers(std::int64_t now_ns);

    /// Until when nothing that is still to come can change light and triggers: a little before the next vertical sync
    /// is due; `now_ns` where none is.
    std::int64_t knownUntil(std::int64_t now_ns) const;
    bool patternMode(std::int64_t now_ns) const;
    bool running() const { return running_; }
    /// It shows a test pattern, which needs no video.
    bool draws(std::int64_t now_ns) const { return !patternMode(now_ns) && input() == 1; }
    /// A command that erases or bricks the projector, or a LED current, has come in (devices.md 1.3: never).
    bool harmed() const { return harmed_; }
    int ledCurrentWrites() const { return ledCurrentWrites_; }
    /// It has stopped answering for good: only a power cycle helps.
    bool hung() const { return hung_; }
    std::size_t messages() const { return messages_; }

private:
    struct Entry {
        int trigger = 0, pattern = 0, depth = 0;
        std::uint8_t leds = 0;
        bool invert = false, blackAfter = false, swaps = false, sharesTrigger = false;
        std::int64_t exposure_ns = 0, period_ns = 0;
    };

    // light_crafter.cpp: packets and commands
    void packet(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
    void obey(std::int64_t now_ns);
    bool write(unsigned command, std::span<const std::uint8_t> payload, std::int64_t now_ns);
    std::optional<Bytes> read(unsigned command, std::int64_t now_ns);
    bool runCommand(std::uint8_t value, std::int64_t now_ns);
    void showVideo(std::int64_t now_ns);
    void reset();
    void acknowledge(bool refused);
    void answer(const Bytes& data);
    void enqueue(Bytes reply);
    Bytes videoStatus(std::int64_t now_ns) const;
    std::uint8_t byteOf(unsigned command) const { return registers_.at(command)[0]; }
    std::uint32_t numberOf(unsigned command, std::size_t offset) const;

    // light_crafter_test_pattern.cpp: pictures of its own
    unsigned input() const { return byteOf(0x1A00) & 7U; }
    void draw(std::int64_t now_ns);
    void endDrawing(std::int64_t now_ns);
    void inputChanged(std::int64_t now_ns);
    FramePtr testPicture() const;

    // light_crafter_sequence.cpp: the LUT and what it makes of the frames
    std::vector<Entry> sequence() const;
    Entry decoded(const std::uint8_t* bytes, std::uint32_t exposure_us, std::uint32_t period_us) const;
    std::uint8_t validated() const;
    bool variableExposure() const;
    void advance(std::int64_t now_ns);
    void begin(std::int64_t now_ns);
    void expose(const Entry& entry, std::int64_t now_ns);
    void triggered(std::int64_t now_ns);
    void stopSequence(std::int64_t now_ns);
    void emit(LightSlot slot);
    LightSlot videoSlot(std::int64_t start_ns, std::int64_t end_ns, FramePtr frame) const;
    std::uint8_t ledsFor(std::uint8_t wanted) const;
    MirrorSettings mirrors() const;
    std::int64_t own_ns(std::int64_t nominal_ns) const;

    LightCrafterOptions options_;
    FaultPlan faults_;

    // The bus
    Bytes message_;
    std::size_t expected_ = 0;
    std::deque<Bytes> replies_;
    bool halted_ = false;
    std::size_t messages_ = 0;
    std::optional<std::int64_t> backOnBus_ns_;

    // Settings
    std::map<unsigned, Bytes> registers_;
    std::array<std::array<std::uint8_t, 3>, 128> patternLut_{};
    std::array<std::uint8_t, 256> imageLut_{};
    std::vector<std::array<std::uint8_t, 12>> variableLut_;
    bool harmed_ = false, hung_ = false;
    int ledCurrentWrites_ = 0, toggles_ = 0;
    std::int64_t deafUntil_ns_ = 0;
    bool pattern_ = false;  ///< what 1A/1B was last told
    std::int64_t patternSince_ns_ = 0;
    std::optional<std::int64_t> validateBy_ns_;
    std::uint8_t validation_ = 0;
    bool checked_ = false;  ///< the LUT as it is has been validated
    std::optional<std::int64_t> ignoredStart_ns_;
    bool freshLut_ = true;
    bool frozen_ = false;

    // Video input and light
    std::optional<VideoSource> source_;
    std::int64_t pluggedAt_ns_ = 0;
    FramePtr arriving_, arrived_, shown_;
    std::uint64_t arrivingNumber_ = 0, arrivedNumber_ = 0, shownNumber_ = 0;
    std::optional<std::int64_t> lastSync_ns_;
    std::optional<std::int64_t> videoFrom_ns_;  ///< the last sync, where it found video mode
    FramePtr drawn_;
    std::int64_t drawnUntil_ns_ = 0;  ///< while there is `drawn_`
    bool running_ = false, waiting_ = false, forcedSwap_ = false;
    std::optional<std::int64_t> stopBy_ns_;
    std::vector<Entry> playing_;
    std::size_t cursor_ = 0;
    std::optional<LightSlot> slot_;
    std::int64_t freeAt_ns_ = 0;
    std::deque<LightSlot> light_;
    std::deque<TriggerEdge> edges_;
};

}  // namespace ilf::devices::emulators
