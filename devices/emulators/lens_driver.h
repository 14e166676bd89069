// An Optotune lens driver 4/4i with its lens that nobody has to own: bytes of a serial line in, bytes and dioptres out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/emulators/fault.h"

namespace ilf::devices::emulators {

using Bytes = std::vector<std::uint8_t>;

/// What a device on a serial line makes of some bytes. `gone`: the cable was pulled in the middle.
struct SerialAnswer {
    Bytes reply;
    bool gone = false;
};

struct LensDriverOptions {
    char firmwareType = 'F';    ///< A-F; decides the coding of focal powers, and D has none
    bool oldFirmware = false;   ///< errors are "N", without a number
    bool hasLensMemory = true;  ///< else serial number and calibration are missing
    double crystal_ppm = 30.0;  ///< its sine runs on this
    bool phaseJumps = true;     ///< a new frequency starts a new period; not known of the real one
    double ambient_C = 30.0;
    double maximum_mA = 292.84;
};

/// Written from devices.md 2.1 (the vendor's manual retold, replies as public drivers read them) and never compared
/// with a driver. Time is in nanoseconds and never goes back. Not for two threads at once.
class EmulatedLensDriver {
public:
    enum class Mode : std::uint8_t { current = 1, sine, triangle, square, focalPower, analog };

    explicit EmulatedLensDriver(LensDriverOptions options = {});

    SerialAnswer receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
    /// The cable was pulled and put back: its memory stays, its output is off.
    void powerCycle(std::int64_t now_ns);
    void setAmbient(double ambient_C, std::int64_t now_ns);
    void setAnalogInput(double volt) { analog_V_ = volt; }
    void setFaults(const std::vector<DeviceFault>& faults) { faults_ = FaultPlan(faults); }

    /// Through the coil, in mA; times may lie in the past as far as the last byte received.
    double current_mA(std::int64_t time_ns) const;
    /// Static power of an invented lens of the EL-16-40-TC's range at this current and warmth; no inertia.
    double power_D(std::int64_t time_ns) const;
    double temperature_C(std::int64_t now_ns);
    Mode mode() const { return mode_; }
    /// How often the memory was written that lasts 100 000 writes.
    int memoryWrites() const { return memoryWrites_; }
    /// RESET or Zw has come in.
    bool harmed() const { return harmed_; }
    /// Of the trigger output, pin A, which toggles with a wave.
    bool pinA(std::int64_t time_ns) const;

private:
    Bytes obey(std::span<const std::uint8_t> message, std::int64_t now_ns);
    Bytes setMode(std::uint8_t letter, std::int64_t now_ns);
    Bytes error(int id) const;
    void warm(std::int64_t now_ns);
    double codeCurrent_mA(double code) const;
    double limited_mA(double current) const;
    double phase(std::int64_t time_ns) const;
    double sensed_C() const { return coil_C_ + faults_.amount(Mishap::overTemperature); }
    std::uint32_t statusWord() const;
    bool hasFocalPower() const { return options_.firmwareType != 'D'; }
    std::uint16_t powerCode(double power_D) const;
    double powerOfCode(std::int16_t code) const;
    std::array<double, 2> powerRange() const;
    double currentFor(double power_D) const;

    LensDriverOptions options_;
    FaultPlan faults_;
    Bytes buffer_;
    std::int64_t lastByte_ns_ = 0;
    Mode mode_ = Mode::current;
    int code_ = 0, upper_ = 0, lower_ = 0;
    std::uint32_t frequency_mHz_ = 1000;
    std::int64_t waveFrom_ns_ = 0;
    double phaseAtStart_ = 0.0;
    double target_D_ = 0.0;
    bool unreachable_ = false;
    std::uint16_t maximum_ = 0;  ///< mA times 100
    int upperLimit_ = 4095, lowerLimit_ = -4095;
    std::uint16_t driftGain_ = 100;
    std::optional<std::array<std::int16_t, 2>> temperatureLimits_;  ///< upper, lower; degrees Celsius times 16
    double analog_V_ = 2.5;
    double coil_C_, ambient_C_;
    std::int64_t warmedTo_ns_ = 0;
    int memoryWrites_ = 0;
    bool harmed_ = false;
};

}  // namespace ilf::devices::emulators
