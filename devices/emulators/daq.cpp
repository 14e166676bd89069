#include "devices/emulators/daq.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ilf::devices::emulators {

namespace {

// devices.md 3.3; of the input, MCC's uldaq (AiUsb1208fsPlus.h: requests, FIFO, 14-byte start block).
constexpr std::uint8_t kReadInput = 0x10, kStartInput = 0x11, kStopInput = 0x12, kRanges = 0x14, kClearInput = 0x15;
constexpr std::uint8_t kSetOutput = 0x18, kStartOutput = 0x1A, kStopOutput = 0x1B, kClearOutput = 0x1C;
constexpr std::uint8_t kCalibration = 0x30, kBlink = 0x41, kReset = 0x42, kStatus = 0x44, kSerial = 0x48;
constexpr std::uint8_t kOutEndpoint = 0x02, kInEndpoint = 0x81;
constexpr std::size_t kOutputFifo = 8192, kInputFifo = 16384, kPacket = 64;
constexpr double kTick_ns = 1e9 / 60e6;
constexpr std::int64_t kReset_ns = 1'000'000'000;  // until it is back on the bus; not documented

constexpr std::uint16_t kInRunning = 0x0002, kOverrun = 0x0004, kOutRunning = 0x0008, kUnderrun = 0x0010;

std::uint32_t number(std::span<const std::uint8_t> data, std::size_t offset) {
    return data[offset] | std::uint32_t(data[offset + 1]) << 8U | std::uint32_t(data[offset + 2]) << 16U |
           std::uint32_t(data[offset + 3]) << 24U;
}

std::vector<int> channelsOf(unsigned mask) {
    std::vector<int> channels;
    for (int channel = 0; channel < 8; ++channel)
        if ((mask >> unsigned(channel) & 1U) != 0) channels.push_back(channel);
    return channels;
}

/// Differential inputs' ranges in volts, by code (uldaq); a single-ended input has +-10 V.
constexpr std::array<double, 8> kDifferential_V = {20.0, 10.0, 5.0, 4.0, 2.5, 2.0, 1.25, 1.0};

}  // namespace

EmulatedDaq::EmulatedDaq(DaqOptions options) : options_(std::move(options)) {}

UsbDescriptors EmulatedDaq::descriptors() const {
    return usbDescriptors({0x09DB,
                           0x00E8,
                           0xFF,
                           "MCC",
                           "USB-1208FS-Plus",
                           options_.serial,
                           {{kInEndpoint, 2, 64}, {kOutEndpoint, 2, 64}}});
}

std::int64_t EmulatedDaq::Scan::tick_ns(std::uint64_t tick) const {
    return start_ns + std::llround(double(tick) * interval_ns);
}

double EmulatedDaq::interval_ns(std::uint32_t pacer) const {
    return (double(pacer) + 1.0) * kTick_ns * (1.0 + faults_.amount(Mishap::clockDrift) * 1e-6);
}

void EmulatedDaq::powerOn(std::int64_t now_ns) {
    output_ = {};
    sampling_ = {};
    outputFifo_.clear();
    inputFifo_.clear();
    ranges_ = {};
    underrun_ = overrun_ = outHalted_ = inHalted_ = differential_ = false;
    now_ = {};
    setOutputs(now_ns);
}

void EmulatedDaq::unplugged(std::int64_t now_ns) {
    advance(now_ns);
    powerOn(now_ns);  // it lives on the cable
}

void EmulatedDaq::setOutputs(std::int64_t time_ns) {
    constexpr std::size_t kForgets = std::size_t(1) << 18U;
    now_.time_ns = time_ns;
    record_.push_back(now_);
    if (record_.size() > kForgets) record_.pop_front();
    constexpr std::size_t kPast = std::size_t(1) << 13U;
    past_.push_back(now_);
    if (past_.size() > kPast) past_.pop_front();
}

OutputSample EmulatedDaq::outputsAt(std::int64_t time_ns) const {
    const auto later = std::ranges::upper_bound(past_, time_ns, {}, &OutputSample::time_ns);
    if (later != past_.begin()) return *std::prev(later);
    return past_.empty() ? now_ : past_.front();
}

UsbTransfer EmulatedDaq::out(std::uint8_t endpoint, std::span<const std::uint8_t> data, std::int64_t now_ns) {
    if (backOnBus_ns_ && now_ns < *backOnBus_ns_) return {UsbAnswer::gone, 0};
    advance(now_ns);
    if (faults_.strikes(Mishap::stall)) outHalted_ = true;
    if (endpoint != kOutEndpoint || outHalted_) return {UsbAnswer::stall, 0};
    if (faults_.strikes(Mishap::silence)) return {UsbAnswer::busy, 0};
    if (faults_.strikes(Mishap::underrun)) {
        outputFifo_.clear();
        underrun_ = true;
    }
    // Whole packets only: the device answers NAK to one it has no room for.
    const std::size_t room = kOutputFifo - outputFifo_.size();
    const std::size_t fits = data.size() <= room ? data.size() : room / kPacket * kPacket;
    const std::size_t passing = faults_.passBefore(Mishap::unplug, fits);
    outputFifo_.insert(outputFifo_.end(), data.begin(), data.begin() + std::ptrdiff_t(passing));
    if (passing < fits) return {UsbAnswer::gone, passing};
    return {fits == data.size() ? UsbAnswer::done : UsbAnswer::busy, fits};
}

UsbTransfer EmulatedDaq::in(std::uint8_t endpoint, std::span<std::uint8_t> room, std::int64_t now_ns) {
    if (backOnBus_ns_ && now_ns < *backOnBus_ns_) return {UsbAnswer::gone, 0};
    advance(now_ns);
    if (endpoint != kInEndpoint || inHalted_) return {UsbAnswer::stall, 0};
    std::size_t ready = std::min(room.size(), inputFifo_.size());
    const bool more = sampling_.running && !sampling_.single;  // then whole packets only
    if (more && ready < room.size()) ready = ready / kPacket * kPacket;
    for (std::size_t i = 0; i < ready; ++i) {
        room[i] = inputFifo_.front();
        inputFifo_.pop_front();
    }
    const bool ended = ready > 0 && !more;
    return {ready == room.size() || ended ? UsbAnswer::done : UsbAnswer::busy, ready};
}

void EmulatedDaq::clearHalt(std::uint8_t endpoint, std::int64_t /*now_ns*/) {
    (endpoint == kOutEndpoint ? outHalted_ : inHalted_) = false;
}

UsbTransfer EmulatedDaq::control(const ControlSetup& setup, std::span<std::uint8_t> data, std::int64_t now_ns) {
    if (backOnBus_ns_ && now_ns < *backOnBus_ns_) return {UsbAnswer::gone, 0};
    advance(now_ns);
    if (faults_.strikes(Mishap::nack)) return {UsbAnswer::stall, 0};
    if (faults_.strikes(Mishap::silence)) return {UsbAnswer::busy, 0};
    const bool towardsHost = setup.requestType == 0xC0;
    if (!towardsHost && setup.requestType != 0x40) return {UsbAnswer::stall, 0};
    if (!towardsHost) {
        const std::size_t passing = faults_.passBefore(Mishap::unplug, 8 + data.size());
        if (passing < 8 + data.size()) return {UsbAnswer::gone, 0};
        return request(setup, data, now_ns);
    }
    Bytes answer;
    switch (setup.request) {
    case kStatus: {
        const std::uint16_t word = status(now_ns);
        answer = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8U)};
        break;
    }
    case kReadInput: {
        if ((setup.value & 0xFFU) > 7 || setup.index > 7) return {UsbAnswer::stall, 0};
        differential_ = (setup.value >> 8U) != 0;
        const int channel = setup.value & 7;
        ranges_[std::size_t(channel)] = static_cast<std::uint8_t>(setup.index);
        const std::uint16_t code = converted(channel, now_ns);
        answer = {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8U)};
        break;
    }
    case kSerial:
        answer.assign(options_.serial.begin(), options_.serial.end());
        break;
    case kCalibration: {  // 40 pairs of slope 1 and offset 0, as 32-bit floats (uldaq); the rest is empty
        const float ideal[2] = {1.0F, 0.0F};
        Bytes memory(768);
        for (std::size_t i = 0; i < 40; ++i)
            std::memcpy(memory.data() + 8 * i, ideal, 8);
        if (setup.value >= memory.size()) return {UsbAnswer::stall, 0};
        answer.assign(memory.begin() + setup.value, memory.end());
        break;
    }
    default:
        return {UsbAnswer::stall, 0};
    }
    const std::size_t bytes = std::min(answer.size(), data.size());
    std::copy_n(answer.begin(), bytes, data.begin());
    return {UsbAnswer::done, bytes};
}

UsbTransfer EmulatedDaq::request(const ControlSetup& setup, std::span<const std::uint8_t> data, std::int64_t now_ns) {
    const auto answered = [&](bool obeyed) {
        return obeyed ? UsbTransfer{UsbAnswer::done, data.size()} : UsbTransfer{UsbAnswer::stall, 0};
    };
    switch (setup.request) {
    case kSetOutput:
        // Not documented: what it does while a scan plays. It is refused, so that nobody leans on it.
        if (setup.index > 1 || output_.running) return answered(false);
        now_.codes[setup.index] = setup.value & 0x0FFFU;  // a 12-bit converter has no more
        now_.joined = true;
        setOutputs(now_ns);
        return answered(true);
    case kStartOutput:
        return answered(startOutput(data, now_ns));
    case kStopOutput:
        output_.running = false;
        return answered(true);
    case kClearOutput:
        outputFifo_.clear();
        return answered(true);
    case kStartInput:
        return answered(startInput(data, now_ns));
    case kStopInput:
        sampling_.running = false;
        return answered(true);
    case kClearInput:
        inputFifo_.clear();
        return answered(true);
    case kRanges:
        if (data.size() != ranges_.size() || std::ranges::any_of(data, [](auto code) { return code > 7; }))
            return answered(false);
        std::ranges::copy(data, ranges_.begin());
        return answered(true);
    case kBlink:
        ++blinks_;
        return answered(true);
    case kReset:
        powerOn(now_ns);
        backOnBus_ns_ = now_ns + kReset_ns;
        return answered(true);
    default:
        return answered(false);
    }
}

// {u32 scan count, u32 pacer period, u8 channel mask}, packed (devices.md 3.3).
bool EmulatedDaq::startOutput(std::span<const std::uint8_t> data, std::int64_t now_ns) {
    if (data.size() != 9 || output_.running || (data[8] & 3U) == 0 || data[8] > 3) return false;
    output_ = {};
    output_.channels = channelsOf(data[8]);
    output_.count = number(data, 0);
    output_.interval_ns = interval_ns(number(data, 4));
    if (output_.interval_ns < 1e9 / 50e3 - 1.0) return false;  // 50 kS/s a channel
    output_.start_ns = now_ns;
    output_.running = true;
    underrun_ = false;
    advance(now_ns);
    return true;
}

// {u32 samples of all channels, u32 retrigger count, u32 pacer period, u8 channel mask, u8 options}, packed (uldaq):
// options bit 0 one sample a packet, bit 1 differential, bits 4:2 trigger, bit 5 retrigger. The pacer ticks for each
// conversion, the channels in turn.
bool EmulatedDaq::startInput(std::span<const std::uint8_t> data, std::int64_t now_ns) {
    if (data.size() != 14 || sampling_.running || data[12] == 0) return false;
    const bool differential = (data[13] & 2U) != 0;
    if ((data[13] & 0xFCU) != 0 || (differential && data[12] > 15)) return false;  // triggers are not emulated
    sampling_ = {};
    sampling_.channels = channelsOf(data[12]);
    sampling_.count = number(data, 0);
    sampling_.interval_ns = interval_ns(number(data, 8));
    if (sampling_.interval_ns < 1e9 / 52e3 - 1.0) return false;  // 52 kS/s altogether
    sampling_.single = (data[13] & 1U) != 0;
    sampling_.start_ns = now_ns;
    sampling_.running = true;
    differential_ = differential;
    overrun_ = false;
    return true;
}

void EmulatedDaq::advance(std::int64_t now_ns) {
    advanceOutput(now_ns);
    advanceInput(knownUntil_ ? std::min(now_ns, knownUntil_(now_ns)) : now_ns);
}

void EmulatedDaq::advanceOutput(std::int64_t now_ns) {
    const std::size_t frame = 2 * output_.channels.size();
    while (output_.running) {
        if (output_.count != 0 && output_.done == output_.count) {
            output_.running = false;
            return;
        }
        const std::int64_t at = output_.tick_ns(output_.done);
        if (at > now_ns) return;
        if (outputFifo_.size() < frame) {
            // It holds what it has and goes on when there is more (devices.md 6.1: 0018 after starving).
            underrun_ = true;
            const auto ticks = static_cast<std::uint64_t>(double(now_ns - output_.start_ns) / output_.interval_ns) + 1;
            output_.done = std::max(output_.done + 1, ticks);
            if (output_.count != 0) output_.done = std::min(output_.done, output_.count);
            continue;
        }
        for (const int channel : output_.channels) {
            const unsigned code = outputFifo_[0] + 256U * outputFifo_[1];
            outputFifo_.erase(outputFifo_.begin(), outputFifo_.begin() + 2);
            now_.codes[std::size_t(channel)] = static_cast<std::uint16_t>(code & 0x0FFFU);
        }
        now_.joined = true;
        setOutputs(at);
        ++output_.done;
    }
}

void EmulatedDaq::advanceInput(std::int64_t now_ns) {
    while (sampling_.running) {
        if (sampling_.count != 0 && sampling_.done == sampling_.count) {
            sampling_.running = false;
            return;
        }
        const std::int64_t at = sampling_.tick_ns(sampling_.done);
        if (at > now_ns) return;
        if (inputFifo_.size() + 2 > kInputFifo) {
            overrun_ = true;
            sampling_.running = false;
            return;
        }
        const int channel = sampling_.channels[sampling_.done % sampling_.channels.size()];
        const std::uint16_t code = converted(channel, at);
        inputFifo_.push_back(static_cast<std::uint8_t>(code));
        inputFifo_.push_back(static_cast<std::uint8_t>(code >> 8U));
        ++sampling_.done;
    }
}

/// 12 bits, offset binary over the range (uldaq).
std::uint16_t EmulatedDaq::converted(int channel, std::int64_t time_ns) const {
    const double range_V = differential_ ? kDifferential_V[ranges_[std::size_t(channel)] & 7U] : 10.0;
    const double volt = input_ ? input_(channel, time_ns) : 0.0;
    const double code = std::floor((volt + range_V) / (2.0 * range_V) * 4096.0);
    return static_cast<std::uint16_t>(std::clamp(std::isfinite(code) ? code : 0.0, 0.0, 4095.0));
}

std::uint16_t EmulatedDaq::status(std::int64_t now_ns) {
    advance(now_ns);
    return static_cast<std::uint16_t>((sampling_.running ? kInRunning : 0) | (overrun_ ? kOverrun : 0) |
                                      (output_.running ? kOutRunning : 0) | (underrun_ ? kUnderrun : 0));
}

std::size_t EmulatedDaq::outputFifoBytes(std::int64_t now_ns) {
    advance(now_ns);
    return outputFifo_.size();
}

OutputSample EmulatedDaq::outputs(std::int64_t now_ns) {
    advance(now_ns);
    return now_;
}

std::vector<OutputSample> EmulatedDaq::takeOutput(std::int64_t now_ns) {
    advance(now_ns);
    std::vector<OutputSample> taken(record_.begin(), record_.end());
    record_.clear();
    return taken;
}

double EmulatedDaq::volts(std::uint16_t code) { return 5.0 * code / 4096.0; }

double EmulatedDaq::current_mA(const OutputSample& sample, int channel) const {
    const AmplifierWiring& wiring = options_.wiring;
    if (wiring.hasRelay && !sample.joined) return 0.0;
    const double wanted = wiring.gain_mA_per_V * (volts(sample.codes[std::size_t(channel)]) - wiring.offset_V);
    return std::clamp(wanted, -wiring.clip_mA, wiring.clip_mA);
}

}  // namespace ilf::devices::emulators
