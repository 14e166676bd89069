// What the DLPC350 says of itself, from its bytes into words.
#pragma once

#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "devices/dlpc350/messages.h"

namespace ilf::devices::dlpc350 {

// Layouts: devices of TI's LightCrafter 4500 GUI 4.0.0 and DLPU010, as their users transcribed them.

/// One of the four numbers of a version.
struct Release {
    int major = 0, minor = 0, patch = 0;
    auto operator<=>(const Release&) const = default;
};
struct Version {
    Release application, api, softwareConfiguration, sequencerConfiguration;
    bool operator==(const Version&) const = default;
};
struct FirmwareTag {
    std::string text;
    bool operator==(const FirmwareTag&) const = default;
};
struct HardwareStatus {
    bool initialised = false;
    bool drcError = false;  ///< bit 2; the maker does not spell the letters out
    bool forcedSwap = false;
    bool sequencerAbort = false;
    bool sequencerError = false;
    bool operator==(const HardwareStatus&) const = default;
};
struct SystemStatus {
    bool memoryTestPassed = false;
    bool operator==(const SystemStatus&) const = default;
};
struct MainStatus {
    bool mirrorsParked = false, sequencerRunning = false, frozen = false, gamma = false;
    bool operator==(const MainStatus&) const = default;
};
/// The picture that arrives at the video input. In pattern mode the board says "not locked" whatever arrives.
struct VideoSignal {
    bool locked = false;
    int width = 0, height = 0;
    Hertz refresh;  ///< in steps of 0.01 Hz
    bool operator==(const VideoSignal&) const = default;
};
/// What the board found when it checked the pattern table.
struct Validation {
    bool busy = false;
    bool exposureInvalid = false, patternNumbersInvalid = false;                      ///< either forbids a start
    bool triggerOverlaps = false, noBlackBeforeTrigger = false, gapTooShort = false;  ///< warnings
    bool mayStart() const { return !busy && !exposureInvalid && !patternNumbersInvalid; }
    bool operator==(const Validation&) const = default;
};

/// From a reply's data; too few bytes are an error (Fault::badFile), more are ignored.
template <class T>
Result<T> parsed(Data data);
template <>
Result<Version> parsed<Version>(Data data);
template <>
Result<FirmwareTag> parsed<FirmwareTag>(Data data);
template <>
Result<HardwareStatus> parsed<HardwareStatus>(Data data);
template <>
Result<SystemStatus> parsed<SystemStatus>(Data data);
template <>
Result<MainStatus> parsed<MainStatus>(Data data);
template <>
Result<VideoSignal> parsed<VideoSignal>(Data data);
template <>
Result<Validation> parsed<Validation>(Data data);

/// The command that reads or sets a T.
template <class T>
inline constexpr Command kCommandOf{};
template <>
inline constexpr Command kCommandOf<Version>{0x02, 0x05, "version"};
template <>
inline constexpr Command kCommandOf<FirmwareTag>{0x1A, 0xFF, "firmware tag"};
template <>
inline constexpr Command kCommandOf<HardwareStatus>{0x1A, 0x0A, "hardware status"};
template <>
inline constexpr Command kCommandOf<SystemStatus>{0x1A, 0x0B, "system status"};
template <>
inline constexpr Command kCommandOf<MainStatus>{0x1A, 0x0C, "main status"};
template <>
inline constexpr Command kCommandOf<VideoSignal>{0x07, 0x1C, "video signal"};
template <>
inline constexpr Command kCommandOf<Validation>{0x1A, 0x1A, "check of the pattern table"};

std::string inWords(const Release& release);
std::string inWords(const VideoSignal& signal);
/// One sentence for each thing that is wrong, with what would help; none: all is well.
std::vector<std::string> troubles(const HardwareStatus& status);
std::vector<std::string> troubles(const SystemStatus& status);
std::vector<std::string> troubles(const MainStatus& status);
/// Why a start is forbidden.
std::vector<std::string> troubles(const Validation& validation);
/// What the check remarks without forbidding a start. A pattern table for streamed video always has the remark on
/// black before a trigger.
std::vector<std::string> remarks(const Validation& validation);
/// What is known of this firmware and matters here.
std::vector<std::string> remarks(const Version& version);

}  // namespace ilf::devices::dlpc350
