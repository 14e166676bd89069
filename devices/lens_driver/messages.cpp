#include "devices/lens_driver/messages.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ilf::devices::lens_driver {
namespace {

constexpr int kFullScale = 4095;
constexpr double kCelsiusPerStep = 0.0625;
constexpr double kCodesPerDioptre = 200.0;

Bytes withCrc(std::string_view letters, std::initializer_list<int> rest = {}) {
    Bytes bytes(letters.begin(), letters.end());
    for (const int byte : rest)
        bytes.push_back(static_cast<std::uint8_t>(byte));
    const auto crc = crc16(bytes);
    bytes.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
    return bytes;
}

constexpr int high(int value) { return (value >> 8) & 0xFF; }
constexpr int low(int value) { return value & 0xFF; }

int clampedCode(int code) { return std::clamp(code, -kFullScale, kFullScale); }

unsigned u16(View data, std::size_t at) { return (unsigned{data[at]} << 8) | data[at + 1]; }
std::int16_t i16(View data, std::size_t at) { return static_cast<std::int16_t>(u16(data, at)); }

tl::unexpected<Error> meaningless(std::string_view what) {
    return fail(Fault::badFile,
                "The lens driver's answer about its " + std::string(what) +
                    " means nothing. Plug it in again; if that does not help, its firmware is not the one "
                    "of the public protocol.");
}

bool endsWell(View frame) {
    return frame[frame.size() - 2] == '\r' && frame[frame.size() - 1] == '\n' &&
           crc16(frame.first(frame.size() - 2)) == 0;
}

}  // namespace

std::uint16_t crc16(View message) {
    unsigned crc = 0;
    for (const auto byte : message) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xA001U : crc >> 1;
    }
    return static_cast<std::uint16_t>(crc);
}

std::string_view word(Mode mode) {
    switch (mode) {
    case Mode::current:
        return "steady current";
    case Mode::sine:
        return "sine";
    case Mode::triangle:
        return "triangle";
    case Mode::square:
        return "square";
    case Mode::focalPower:
        return "focal power";
    case Mode::analog:
        return "analog input";
    case Mode::position:
        return "position";
    }
    return "?";
}

Command readFirmwareType() { return {"read the firmware type", withCrc("H"), {'H', 1, 1}}; }
Command readVersion() { return {"read the firmware version", withCrc("V"), {'V', 1, 6}}; }
Command readLensSerial() { return {"read the lens's serial number", withCrc("X"), {'X', 1, 8}}; }
Command readMaxCurrent() { return {"read the greatest current", withCrc("CrMA", {0, 0}), {'C', 3, 2}}; }
Command readUpperLimit() { return {"read the upper limit", withCrc("CrUA", {0, 0}), {'C', 3, 2}}; }
Command readLowerLimit() { return {"read the lower limit", withCrc("CrLA", {0, 0}), {'C', 3, 2}}; }
Command readCurrent() { return {"read the current", withCrc("Ar", {0, 0}), {'A', 1, 2}}; }
Command readMode() { return {"read the mode", withCrc("MMA"), {'M', 3, 1}}; }
Command readFrequency() { return {"read the frequency", withCrc("PrFA", {0, 0, 0, 0}), {'P', 3, 4}}; }
Command readTemperature() { return {"read the temperature", withCrc("TCA"), {'T', 3, 2}}; }
Command readStatus() { return {"read the status", withCrc("Sr"), {'S', 1, 4, 2}}; }

Command setCurrent(int code) {
    const int safe = clampedCode(code);
    return {"set the current", withCrc("Aw", {high(safe), low(safe)}), {}};
}

Command setMode(Mode mode) {
    switch (mode) {
    case Mode::current:
        return {"take steady currents", withCrc("MwDA"), {'M', 3, 0}};
    case Mode::sine:
        return {"drive a sine", withCrc("MwSA"), {'M', 3, 0}};
    case Mode::triangle:
        return {"drive a triangle", withCrc("MwTA"), {'M', 3, 0}};
    case Mode::square:
        return {"drive a square", withCrc("MwQA"), {'M', 3, 0}};
    case Mode::focalPower:
        return {"take focal powers", withCrc("MwCA"), {'M', 3, 5}};
    case Mode::analog:
        return {"follow the analog input", withCrc("MwAA"), {'M', 3, 0}};
    case Mode::position:
        break;
    }
    assert(false && "no command of the public table sets this mode");
    return setMode(Mode::current);
}

Command setFrequency(std::uint32_t milliHertz) {
    const auto part = [&](int shift) { return static_cast<int>((milliHertz >> shift) & 0xFF); };
    return {"set the frequency", withCrc("PwFA", {part(24), part(16), part(8), part(0)}), {}};
}
Command setUpperSwing(int code) {
    const int safe = clampedCode(code);
    return {"set the upper swing", withCrc("PwUA", {high(safe), low(safe), 0, 0}), {}};
}
Command setLowerSwing(int code) {
    const int safe = clampedCode(code);
    return {"set the lower swing", withCrc("PwLA", {high(safe), low(safe), 0, 0}), {}};
}
Command setFocalPower(std::int16_t code) {
    return {"set the focal power", withCrc("PwDA", {high(code), low(code), 0, 0}), {}};
}
Command setTemperatureLimits(double low_C, double high_C) {
    const auto step = [](double celsius) {
        return static_cast<int>(std::lround(std::clamp(celsius, -273.0, 2000.0) / kCelsiusPerStep));
    };
    const int most = step(high_C), least = step(low_C);
    return {"set the temperature limits",
            withCrc("PwTA", {high(most), low(most), high(least), low(least)}),
            {'P', 2, 5, 3}};
}

Frame framed(View received, const Answer& expected) {
    constexpr std::size_t kEnd = 4, kError = 6, kUnknown = 3;
    using Kind = Frame::Kind;
    if (received.empty()) return {};
    const char first = static_cast<char>(received[0]);
    Frame noise{Kind::noise, 1, 0, {}};
    if (expected.first != 0 && first == expected.first) {
        bool may = false;
        for (const int letters : {expected.letters, expected.otherLetters}) {
            if (letters == 0) continue;
            const std::size_t length = static_cast<std::size_t>(letters + expected.data) + kEnd;
            if (received.size() < length) {
                may = true;
                continue;
            }
            const auto frame = received.first(length);
            if (!endsWell(frame)) continue;
            const auto data = frame.subspan(static_cast<std::size_t>(letters), static_cast<std::size_t>(expected.data));
            return {Kind::answer, length, 0, Bytes(data.begin(), data.end())};
        }
        return may ? Frame{} : noise;
    }
    if (first == 'E') {
        if (received.size() < kError) return {};
        return endsWell(received.first(kError)) ? Frame{Kind::error, kError, received[1], {}} : noise;
    }
    if (first == 'N') {
        if (received.size() < kUnknown) return {};
        return received[1] == '\r' && received[2] == '\n' ? Frame{Kind::unknown, kUnknown, 0, {}} : noise;
    }
    return noise;
}

std::string errorWords(std::uint8_t error) {
    switch (error) {
    case 1:
        return "the message arrived damaged (CRC); check the USB cable";
    case 2:
        return "its firmware type cannot do that";
    case 3:
        return "it does not know that command; its firmware may be too old";
    case 4:
        return "the lens that is plugged in cannot do that; check the lens and its cable";
    default:
        return "it gave error number " + std::to_string(error) + ", which the public table does not list";
    }
}

Result<char> firmwareTypeFrom(View data) {
    if (data.size() != 1 || data[0] < 'A' || data[0] > 'Z') return meaningless("firmware type");
    return static_cast<char>(data[0]);
}

Result<Version> versionFrom(View data) {
    if (data.size() != 6) return meaningless("firmware version");
    return Version{data[0], data[1], static_cast<int>(u16(data, 2)), static_cast<int>(u16(data, 4))};
}

Result<std::string> lensSerialFrom(View data) {
    if (data.size() != 8) return meaningless("lens's serial number");
    const auto all = [&](int value) {
        return std::all_of(data.begin(), data.end(), [&](auto b) { return b == value; });
    };
    if (all(0) || all(0xFF)) return std::string();
    std::string serial;
    for (const auto byte : data) {
        if (byte >= 0x20 && byte < 0x7F) serial.push_back(static_cast<char>(byte));
    }
    return serial;
}

Result<Ampere> maxCurrentFrom(View data) {
    // None, or more than twice the 290 mA that its hardware can give.
    if (data.size() != 2 || u16(data, 0) == 0 || u16(data, 0) > 60000) return meaningless("greatest current");
    return Ampere::fromSi(u16(data, 0) * 1e-5);
}

Result<int> codeFrom(View data) {
    if (data.size() != 2) return meaningless("current");
    // Drivers that scale by 4096 may answer with it.
    if (const int code = i16(data, 0); std::abs(code) <= kFullScale + 1) return code;
    return meaningless("current");
}

Result<Mode> modeFrom(View data) {
    if (data.size() != 1 || data[0] < 1 || data[0] > 7) return meaningless("mode");
    return static_cast<Mode>(data[0]);
}

Result<Hertz> frequencyFrom(View data) {
    if (data.size() != 4) return meaningless("frequency");
    return Hertz::fromSi((u16(data, 0) * 65536.0 + u16(data, 2)) / 1e3);
}

Result<double> temperatureFrom(View data) {
    if (data.size() != 2) return meaningless("temperature");
    const double celsius = i16(data, 0) * kCelsiusPerStep;
    // What the sensor can give; a sensor that is not there reads as one end of 16 bits.
    if (celsius < -55.0 || celsius > 150.0) return meaningless("temperature");
    return celsius;
}

Result<Status> statusFrom(View data) {
    if (data.size() != 4) return meaningless("status");
    const auto bit = [&](std::size_t byte, int which) { return ((data[byte] >> which) & 1) != 0; };
    return Status{bit(3, 0), bit(3, 1), bit(3, 2), bit(3, 3), bit(3, 4), bit(3, 5), bit(3, 6), bit(3, 7), bit(2, 0)};
}

std::vector<std::string> words(const Status& status) {
    std::vector<std::string> all;
    const auto say = [&](bool set, const char* what) {
        if (set) all.emplace_back(what);
    };
    say(status.hardware, "the driver reports a hardware fault");
    say(status.eeprom, "the lens's memory cannot be read");
    say(status.noTemperatureLimits, "no temperature limits are set for focal powers");
    say(status.powerUnreachable, "the focal power asked for cannot be reached");
    say(status.inversion, "the current is turned round");
    say(status.outsideTemperature, "the lens is outside the temperatures it is specified for");
    say(status.outsideGuaranteed, "the focal power is outside the guaranteed range");
    say(status.outsideUserTemperature, "the lens is outside the temperature limits that were set");
    say(status.incompatible, "the lens does not go with this driver");
    return all;
}

Result<PowerRange> powerRangeFrom(View data, char firmwareType) {
    if (data.size() != 5) return meaningless("range of focal powers");
    const auto most = powerOf(i16(data, 1), firmwareType), least = powerOf(i16(data, 3), firmwareType);
    if (!most || !least || *least > *most) return meaningless("range of focal powers");
    return PowerRange{*least, *most};
}

int codeOf(Ampere current, Ampere most) {
    assert(most > Ampere());
    if (!isFinite(current)) return 0;
    return static_cast<int>(std::lround(std::clamp(current / most, -1.0, 1.0) * kFullScale));
}

Ampere currentOf(int code, Ampere most) { return (static_cast<double>(code) / kFullScale) * most; }

namespace {

/// By how much a type's codes are shifted, in dioptres; none for types that are not known to take focal powers.
std::optional<double> shiftOf(char firmwareType) {
    if (firmwareType == 'A') return 5.0;
    if (firmwareType == 'B' || firmwareType == 'C' || firmwareType == 'E' || firmwareType == 'F') return 0.0;
    return std::nullopt;
}

}  // namespace

std::optional<std::int16_t> powerCode(Dioptre power, char firmwareType) {
    const auto shift = shiftOf(firmwareType);
    if (!shift || !isFinite(power)) return std::nullopt;
    const double code = std::round((power.si() + *shift) * kCodesPerDioptre);
    using Limits = std::numeric_limits<std::int16_t>;
    if (code < Limits::min() || code > Limits::max()) return std::nullopt;
    return static_cast<std::int16_t>(code);
}

std::optional<Dioptre> powerOf(std::int16_t code, char firmwareType) {
    const auto shift = shiftOf(firmwareType);
    if (!shift) return std::nullopt;
    return Dioptre::fromSi(code / kCodesPerDioptre - *shift);
}

}  // namespace ilf::devices::lens_driver
