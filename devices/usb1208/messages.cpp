#include "devices/usb1208/messages.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace ilf::devices::usb1208 {
namespace {

constexpr double kOutputRangeVolts = 5.0, kInputRangeVolts = 10.0;

void put32(Bytes& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>((value >> shift) & 0xFF));
}

std::uint16_t u16(View data, std::size_t at) {
    return static_cast<std::uint16_t>(unsigned{data[at]} | unsigned{data[at + 1]} << 8);
}

double f32(View data, std::size_t at) {
    return std::bit_cast<float>(std::uint32_t{u16(data, at)} | std::uint32_t{u16(data, at + 2)} << 16);
}

tl::unexpected<Error> tooShort(const char* what) {
    return fail(Fault::badFile,
                std::string("The USB-1208FS-Plus gave too little data about its ") + what + ". Plug it in again.");
}

}  // namespace

VendorRequest setOutput(int channel, std::uint16_t code) {
    assert(channel >= 0 && channel < kOutputs && code < kCodes);
    return {0x18, code, static_cast<std::uint16_t>(channel), "told what its outputs shall hold"};
}

Bytes outputScan() {
    Bytes data;
    put32(data, 0);
    put32(data, kPacer);
    data.push_back(0x03);
    return data;
}

Bytes inputScan(std::uint8_t channels) {
    Bytes data;
    put32(data, 0);
    put32(data, 0);  // no retrigger
    put32(data, kPacer);
    data.push_back(channels);
    data.push_back(0);
    return data;
}

Result<Status> statusFrom(View data) {
    if (data.size() < kStatusBytes) return tooShort("state");
    const unsigned bits = u16(data, 0);
    return Status{(bits & 0x0002) != 0, (bits & 0x0004) != 0, (bits & 0x0008) != 0, (bits & 0x0010) != 0};
}

Result<std::array<std::uint16_t, kOutputs>> outputsFrom(View data) {
    if (data.size() < kReadOutputsBytes) return tooShort("outputs");
    return std::array<std::uint16_t, kOutputs>{u16(data, 0), u16(data, 2)};
}

std::uint16_t outputCode(Volt volts) {
    if (!isFinite(volts)) return 0;
    const double code = std::round(volts.si() * kCodes / kOutputRangeVolts);
    return static_cast<std::uint16_t>(std::clamp(code, 0.0, kCodes - 1.0));
}

Volt outputVolts(std::uint16_t code) { return Volt::fromSi(code * kOutputRangeVolts / kCodes); }

void putSample(std::span<std::uint8_t> two, std::uint16_t code) {
    two[0] = static_cast<std::uint8_t>(code & 0xFF);
    two[1] = static_cast<std::uint8_t>(code >> 8);
}

std::uint16_t sampleAt(View two) { return u16(two, 0); }

InputCalibrations inputCalibrationsFrom(View data) {
    if (data.size() < kInputCalibrationBytes) return {};
    InputCalibrations all;
    all.factory = true;
    for (std::size_t i = 0; i < all.channels.size(); ++i) {
        const InputCalibration one{f32(data, 8 * i), f32(data, 8 * i + 4)};
        const bool plausible = std::abs(one.slope - 1.0) <= 0.1 && std::abs(one.offset) <= 0.05 * kCodes;
        if (!plausible) return {};  // a number that is none is not plausible either
        all.channels[i] = one;
    }
    return all;
}

Volt inputVolts(std::uint16_t code, const InputCalibration& calibration) {
    const double calibrated = code * calibration.slope + calibration.offset;
    return Volt::fromSi((calibrated - kCodes / 2.0) * kInputRangeVolts / (kCodes / 2.0));
}

Result<int> samplesPerSweep(Hertz rate) {
    constexpr double kMost = 20e-6;
    if (!(rate >= 1.0_Hz && rate <= 500.0_Hz))
        return fail(Fault::outOfRange, "The DAC plays sweeps of 1 to 500 Hz. Choose another sweep rate.");
    const double samples = std::round(kSampleRateHz / rate.si());
    const double nearest = kSampleRateHz / samples;
    if (std::abs(nearest / rate.si() - 1.0) > kMost) {
        const auto text = [](double value) {
            const auto digits = std::to_string(value);
            return digits.substr(0, digits.find('.') + 4);
        };
        return fail(Fault::unsupported, "The DAC plays a whole number of samples in each sweep and cannot play " +
                                            text(rate.si()) + " Hz. Set projector and rig to " +
                                            text(rate > 59.0_Hz && rate < 61.0_Hz ? 60.0 : nearest) + " Hz.");
    }
    return static_cast<int>(samples);
}

}  // namespace ilf::devices::usb1208
