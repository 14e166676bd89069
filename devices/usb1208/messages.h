// The vendor requests, structures and sample codes of Measurement Computing's USB-1208FS-Plus.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "devices/usb/usb_link.h"

/// Numbers in, bytes out, all little endian; nothing here waits, and no bytes can crash it.
///
///     hold 2.5 V on AO1        control out 0x18, value 0x0800, index 1
///     start both outputs       control out 0x1A, data 00 00 00 00  E1 04 00 00  03
///                                   (0 = until stopped; 60 MHz / 48 kS/s - 1 = 1249; channels 0 and 1)
///     the device's state       control in 0x44, 2 bytes: 0002 input runs, 0004 overrun, 0008 output runs, 0010
///     underrun samples                  bulk, u16, 12 bits used; AO0 AO1 AO0 AO1 ...
///
/// Outputs and status: Measurement Computing's own library (uldaq), as the device reference gives them. Inputs, the
/// calibration memory and reading outputs back: uldaq and a second, independent public driver agree, or (reading
/// outputs back) only the latter has it; none of it was ever tried on hardware here. Outputs have no factory
/// calibration (uldaq: no coefficients), so their codes are nominal.
namespace ilf::devices::usb1208 {

inline constexpr std::uint16_t kVendor = 0x09DB, kProduct = 0x00E8;
inline constexpr double kClockHz = 60e6;
/// 48 kS/s: with it 60 Hz is exactly 800 samples.
inline constexpr std::uint32_t kPacer = 1250 - 1;
inline constexpr double kSampleRateHz = kClockHz / (kPacer + 1);
inline constexpr int kOutputs = 2, kInputs = 8;
/// What the device itself buffers of the outputs.
inline constexpr std::size_t kOutputFifoBytes = 8192;
inline constexpr std::size_t kBytesPerFrame = 2 * std::size_t{kOutputs};
/// Of one transfer: 10 ms, and a whole number of the 64-byte packets of full speed.
inline constexpr std::size_t kTransferFrames = 480;
inline constexpr int kCodes = 4096;

using View = std::span<const std::uint8_t>;

/// Without data. Refused by the device while an output scan runs. Precondition: channel 0 or 1, code below 4096.
VendorRequest setOutput(int channel, std::uint16_t code);
/// Data: `outputScan()`.
inline constexpr VendorRequest kStartOutput{0x1A, 0, 0, "told to start its outputs"},
    kStopOutput{0x1B, 0, 0, "told to stop its outputs"}, kClearOutput{0x1C, 0, 0, "told to empty its outputs' buffer"};
/// Read; 4 bytes: the code of each output. Unverified, the vendor's library does not use it.
inline constexpr VendorRequest kReadOutputs{0x18, 0, 0, "asked what its outputs hold"};
inline constexpr std::size_t kReadOutputsBytes = 4;
/// Read; 2 bytes.
inline constexpr VendorRequest kReadStatus{0x44, 0, 0, "asked for its state"};
inline constexpr std::size_t kStatusBytes = 2;
/// Data of `kConfigureInput`: one range for each input, 0 = +-10 V against ground; of `kStartInput`: `inputScan()`.
inline constexpr VendorRequest kStartInput{0x11, 0, 0, "told to start its inputs"},
    kStopInput{0x12, 0, 0, "told to stop its inputs"}, kConfigureInput{0x14, 0, 0, "told the ranges of its inputs"},
    kClearInput{0x15, 0, 0, "told to empty its inputs' buffer"};
/// Read; 64 bytes of the calibration memory: slope and offset of the eight inputs against ground, as 32-bit floats.
inline constexpr VendorRequest kReadInputCalibration{0x30, 0x100, 0, "asked for its calibration"};
inline constexpr std::size_t kInputCalibrationBytes = 64;

/// Both outputs, until stopped; an underrun stalls the endpoint.
Bytes outputScan();
/// The inputs whose bits are set in `channels`, one after the other at 48 kS/s together, until stopped, against ground,
/// in blocks; an overrun stalls the endpoint. So one input has 48 kS/s, two have 24 kS/s each, the second one half
/// of its period later.
Bytes inputScan(std::uint8_t channels);
inline Bytes inputRanges() { return Bytes(kInputs, 0); }

struct Status {
    bool inputRuns = false, overrun = false, outputRuns = false, underrun = false;
    bool operator==(const Status&) const = default;
};
Result<Status> statusFrom(View data);
Result<std::array<std::uint16_t, kOutputs>> outputsFrom(View data);

/// Of a 12-bit converter for 0 to 5 V, nominal; clamped to what it can give. One step is 1.22 mV.
std::uint16_t outputCode(Volt volts);
Volt outputVolts(std::uint16_t code);
void putSample(std::span<std::uint8_t> two, std::uint16_t code);
std::uint16_t sampleAt(View two);

/// calibrated code = code * slope + offset.
struct InputCalibration {
    double slope = 1.0, offset = 0.0;
    bool operator==(const InputCalibration&) const = default;
};
struct InputCalibrations {
    std::array<InputCalibration, kInputs> channels;
    bool factory = false;  ///< else nominal codes: say so
};
/// Nominal codes where the data is not what a factory would write (not finite, more than 10 % from 1, more than 5 % of
/// the range from 0).
InputCalibrations inputCalibrationsFrom(View data);
/// +-10 V.
Volt inputVolts(std::uint16_t code, const InputCalibration& calibration);

/// Samples that a sweep of `rate` has at 48 kS/s. Refused (with the nearest rate) where no whole number of samples
/// comes within 20 ppm: the rest could not be told from drift of the projector. 60 Hz: 800.
Result<int> samplesPerSweep(Hertz rate);

}  // namespace ilf::devices::usb1208
