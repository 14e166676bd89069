// The bytes that Optotune's lens drivers 4 and 4i understand, and what their answers mean.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"

/// Numbers in, bytes out; bytes in, numbers out. Nothing here waits, and no bytes can crash it.
///
///     set current 1402     41 77 05 7A 26 95     "Aw", i16 high byte first; the CRC, low byte first
///     read mode            4D 4D 41 65 77        "MMA"; the official example's CRC (58 6B) is wrong
///     its answer, sine     4D 4D 41 02 cc cc 0D 0A
///     an error, CRC wrong  45 01 F3 50 0D 0A
///
/// Answers may contain 0D 0A in their data, so they are told apart by length and CRC, never by line.
///
/// Known from: the manual of 30.3.2016 and its table of commands; 40 of their 41 examples have the CRC computed here.
/// Lengths of answers are from public drivers (Voxel, opto and others agree). They disagree about two, so both lengths
/// are taken there: `PwTA` (2 or 3 letters before the status byte) and `Sr` (1 or 2 letters before the status).
/// Not known: full scale. The table divides by 4095, the manual's text by 4096 (0.02 % apart); 4095 is used.
/// Left out on purpose: everything that writes the EEPROM (`Zw`, `CwMA`, `CwUA`, `CwLA`) and `RESET`, which starts the
/// bootloader.
namespace ilf::devices::lens_driver {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

/// CRC-16/ARC: reflected polynomial 0xA001, from 0, no final xor. Of a message with its CRC (low byte first) it is 0.
std::uint16_t crc16(View message);

/// What an answer looks like: letters that repeat the command, the first of them `first`, then `data` bytes, the CRC
/// and 0D 0A. `first` = 0: there is no answer unless something is wrong.
struct Answer {
    char first = 0;
    int letters = 0, data = 0;
    int otherLetters = 0;  ///< some firmware sends so many instead; 0: none known
};
struct Command {
    std::string_view name;  ///< for messages: "read the temperature"
    Bytes bytes;
    Answer answer;
};

enum class Mode : std::uint8_t { current = 1, sine, triangle, square, focalPower, analog, position };
std::string_view word(Mode mode);

/// "Start", which has no CRC and is answered by "Ready\r\n". It also sets the current to 0.
inline constexpr std::string_view kStart = "Start";
inline constexpr std::string_view kReady = "Ready\r\n";

Command readFirmwareType();
Command readVersion();
Command readLensSerial();
Command readMaxCurrent();
Command readUpperLimit();
Command readLowerLimit();
Command readCurrent();
Command readMode();
Command readFrequency();
Command readTemperature();
Command readStatus();
/// -4095..4095, others are clamped.
Command setCurrent(int code);
/// Precondition: not `position`, which no command of the public table sets.
Command setMode(Mode mode);
/// Sine, triangle and square.
Command setFrequency(std::uint32_t milliHertz);
Command setUpperSwing(int code);
Command setLowerSwing(int code);
Command setFocalPower(std::int16_t code);
/// Within which temperatures focal powers must be reachable; clamped to what 12.4 bits hold.
Command setTemperatureLimits(double low_C, double high_C);

/// What stands at the beginning of what was received.
struct Frame {
    enum class Kind {
        more,     ///< nothing complete yet
        answer,   ///< `data` without letters, CRC and line end
        error,    ///< the driver refused: `error`
        unknown,  ///< "N\r\n": how old firmware refuses
        noise,    ///< the first byte begins nothing that was expected
    };
    Kind kind = Kind::more;
    std::size_t used = 0;  ///< bytes to take off
    std::uint8_t error = 0;
    Bytes data;
};
Frame framed(View received, const Answer& expected);
/// What an error number means, and what would help.
std::string errorWords(std::uint8_t error);

// Decoders of `Frame::data`; data of another length, or values that mean nothing, are `badFile`.

struct Version {
    int major = 0, minor = 0, build = 0, revision = 0;
    bool operator==(const Version&) const = default;
};
Result<char> firmwareTypeFrom(View data);
Result<Version> versionFrom(View data);
/// Empty: the lens has no EEPROM (only zeros, or only ones, were read).
Result<std::string> lensSerialFrom(View data);
Result<Ampere> maxCurrentFrom(View data);
/// Of the limits and the current.
Result<int> codeFrom(View data);
Result<Mode> modeFrom(View data);
Result<Hertz> frequencyFrom(View data);
/// Of the lens, in degrees Celsius.
Result<double> temperatureFrom(View data);

/// What the driver says of itself; true is bad.
struct Status {
    bool hardware = false, eeprom = false, noTemperatureLimits = false, powerUnreachable = false, inversion = false;
    bool outsideTemperature = false, outsideGuaranteed = false, outsideUserTemperature = false, incompatible = false;
    bool operator==(const Status&) const = default;
};
Result<Status> statusFrom(View data);
/// One clause for each bit that is set.
std::vector<std::string> words(const Status& status);

/// Focal powers that can be reached, from the answers to `setMode(Mode::focalPower)` and `setTemperatureLimits`.
struct PowerRange {
    Dioptre low, high;
};
Result<PowerRange> powerRangeFrom(View data, char firmwareType);

/// Current codes are shares of the driver's greatest current. Precondition: `most` > 0.
int codeOf(Ampere current, Ampere most);
Ampere currentOf(int code, Ampere most);
/// (D + 5) 200 for type A, D 200 for B, C, E and F. None: the type is not known to take focal powers, or the power
/// does not fit into 16 bits.
std::optional<std::int16_t> powerCode(Dioptre power, char firmwareType);
std::optional<Dioptre> powerOf(std::int16_t code, char firmwareType);

}  // namespace ilf::devices::lens_driver
