// A converter MCC USB-1208FS-Plus that nobody has to own, and the amplifier behind it: samples in, coil currents out.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/emulators/fault.h"
#include "devices/emulators/usb_device.h"

namespace ilf::devices::emulators {

/// Between an analog output (0..5 V) and a coil: I = gain * (U - offset), clipped. The relay joins them only once an
/// output was told something, since 0 V alone would drive the coil to its end (devices.md 3.5).
struct AmplifierWiring {
    double gain_mA_per_V = 100.0, offset_V = 2.5, clip_mA = 293.0;
    bool hasRelay = true;
    bool operator==(const AmplifierWiring&) const = default;
};

struct DaqOptions {
    std::string serial = "01F0A1B2";
    AmplifierWiring wiring;
};

/// Both outputs from `time_ns` on.
struct OutputSample {
    std::int64_t time_ns = 0;
    std::array<std::uint16_t, 2> codes = {0, 0};  ///< 0..4095
    bool joined = false;                          ///< the relay is closed
    bool operator==(const OutputSample&) const = default;
};

/// Requests, status bits, FIFO and clock as devices.md 3.3 gives them; the analog input as MCC's own library (uldaq)
/// drives it. Never compared with a device.
class EmulatedDaq final : public EmulatedUsbDevice {
public:
    /// Volts at an analog input (0..7) at a time; called with times that go forward, a little behind now.
    using AnalogInput = std::function<double(int channel, std::int64_t time_ns)>;

    explicit EmulatedDaq(DaqOptions options = {});

    UsbDescriptors descriptors() const override;
    UsbTransfer out(std::uint8_t endpoint, std::span<const std::uint8_t> data, std::int64_t now_ns) override;
    UsbTransfer in(std::uint8_t endpoint, std::span<std::uint8_t> room, std::int64_t now_ns) override;
    UsbTransfer control(const ControlSetup& setup, std::span<std::uint8_t> data, std::int64_t now_ns) override;
    void clearHalt(std::uint8_t endpoint, std::int64_t now_ns) override;
    void unplugged(std::int64_t now_ns) override;
    std::optional<std::int64_t> backOnBusAt() const override { return backOnBus_ns_; }

    /// `knownUntil`: up to when the input can be told, given now; samples later than that wait. Empty: up to now.
    void setInput(AnalogInput input, std::function<std::int64_t(std::int64_t now_ns)> knownUntil = {}) {
        input_ = std::move(input);
        knownUntil_ = std::move(knownUntil);
    }
    void setFaults(const std::vector<DeviceFault>& faults) { faults_ = FaultPlan(faults); }

    /// Every change of the outputs by `now_ns`, in order; the last 2^18 where nobody asked for them in time.
    std::vector<OutputSample> takeOutput(std::int64_t now_ns);
    OutputSample outputs(std::int64_t now_ns);
    /// What the outputs held at a time not longer ago than 2^13 changes; what they hold now for a later one.
    OutputSample outputsAt(std::int64_t time_ns) const;
    static double volts(std::uint16_t code);
    /// What the amplifier drives through a coil, in mA; 0 while its relay is open.
    double current_mA(const OutputSample& sample, int channel) const;
    /// The status word of request 0x44.
    std::uint16_t status(std::int64_t now_ns);
    std::size_t outputFifoBytes(std::int64_t now_ns);
    int blinks() const { return blinks_; }

private:
    struct Scan {
        bool running = false;
        std::int64_t start_ns = 0;
        std::uint64_t done = 0, count = 0;  ///< ticks; a count of 0 goes on for ever
        double interval_ns = 0.0;
        std::vector<int> channels;
        bool single = false;  ///< input: samples are handed over one by one, not in packets
        std::int64_t tick_ns(std::uint64_t tick) const;
    };

    UsbTransfer request(const ControlSetup& setup, std::span<const std::uint8_t> data, std::int64_t now_ns);
    bool startOutput(std::span<const std::uint8_t> data, std::int64_t now_ns);
    bool startInput(std::span<const std::uint8_t> data, std::int64_t now_ns);
    void advance(std::int64_t now_ns);
    void advanceOutput(std::int64_t now_ns);
    void advanceInput(std::int64_t now_ns);
    void setOutputs(std::int64_t time_ns);
    std::uint16_t converted(int channel, std::int64_t time_ns) const;
    double interval_ns(std::uint32_t pacer) const;
    void powerOn(std::int64_t now_ns);

    DaqOptions options_;
    FaultPlan faults_;
    AnalogInput input_;
    std::function<std::int64_t(std::int64_t)> knownUntil_;
    Scan output_, sampling_;
    std::deque<std::uint8_t> outputFifo_, inputFifo_;
    std::array<std::uint8_t, 8> ranges_{};
    bool differential_ = false;
    bool underrun_ = false, overrun_ = false;
    bool outHalted_ = false, inHalted_ = false;
    OutputSample now_;
    std::deque<OutputSample> record_, past_;  ///< not taken yet; the last ones, taken or not
    int blinks_ = 0;
    std::optional<std::int64_t> backOnBus_ns_;
};

}  // namespace ilf::devices::emulators
