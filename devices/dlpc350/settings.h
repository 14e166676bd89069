// The settings of the DLPC350 that pattern display needs, between numbers and bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "devices/dlpc350/status.h"

namespace ilf::devices::dlpc350 {

// Left out on purpose, so that no caller can reach them: LED currents, program mode, the bootloader, software reset.

enum class Display : std::uint8_t { video = 0, pattern = 1 };
enum class PatternSource : std::uint8_t { videoPort = 0, flash = 3 };
enum class TriggerMode : std::uint8_t {
    vsync = 0,  ///< fixed exposure
    triggerIn1 = 1,
    triggerIn1And2 = 2,
    variableTriggerIn1 = 3,
    variableVsync = 4,
};
enum class PatternRun : std::uint8_t { stopped = 0, paused = 1, running = 2 };

/// How long each pattern is lit, and how long it lasts; the same in both VSYNC modes. Whole microseconds.
struct ExposurePeriod {
    std::uint32_t exposure_us = 0, period_us = 0;
    bool operator==(const ExposurePeriod&) const = default;
};

/// How the pattern table is run through. `entries` 1 ... 128, `perTrigOut2` 1 ... 256, `images` 1 ... 64 (flash only).
struct LutControl {
    int entries = 1;
    bool repeat = true;
    int perTrigOut2 = 1;
    int images = 1;
    bool operator==(const LutControl&) const = default;
};

/// Who switches the LEDs. Anything but the sequencer makes every pattern white or grey, so only that can be set.
struct LedControl {
    bool sequencer = true;
    bool red = false, green = false, blue = false;
    bool operator==(const LedControl&) const = default;
};

/// TRIG_OUT_1 frames every pattern, TRIG_OUT_2 marks the start of the sequence. Delays are codes: 0xBB is none, each
/// step 107.136 ns. `polarity` is the raw byte: documents differ on whether bit 0 (TI's code) or bit 1 (its guide)
/// inverts; nobody could try it here.
struct TriggerOut1 {
    std::uint8_t polarity = 0, risingDelay = 0xBB, fallingDelay = 0xBB;
    bool operator==(const TriggerOut1&) const = default;
};
struct TriggerOut2 {
    std::uint8_t polarity = 0, risingDelay = 0xBB;
    bool operator==(const TriggerOut2&) const = default;
};

/// Which table is being written; they cannot be read back.
enum class Mailbox : std::uint8_t { closed = 0, imageIndex = 1, patterns = 2 };
struct MailboxOffset {
    std::uint8_t entry = 0;  ///< 0 ... 127
};
inline constexpr Command kMailboxData{0x1A, 0x34, "pattern table"};

template <>
inline constexpr Command kCommandOf<Display>{0x1A, 0x1B, "display mode"};
template <>
inline constexpr Command kCommandOf<PatternSource>{0x1A, 0x22, "pattern source"};
template <>
inline constexpr Command kCommandOf<TriggerMode>{0x1A, 0x23, "trigger mode"};
template <>
inline constexpr Command kCommandOf<PatternRun>{0x1A, 0x24, "pattern run"};
template <>
inline constexpr Command kCommandOf<ExposurePeriod>{0x1A, 0x29, "exposure and period"};
template <>
inline constexpr Command kCommandOf<LutControl>{0x1A, 0x31, "pattern table's length"};
template <>
inline constexpr Command kCommandOf<LedControl>{0x1A, 0x07, "LED control"};
template <>
inline constexpr Command kCommandOf<TriggerOut1>{0x1A, 0x1D, "TRIG_OUT_1"};
template <>
inline constexpr Command kCommandOf<TriggerOut2>{0x1A, 0x1E, "TRIG_OUT_2"};
template <>
inline constexpr Command kCommandOf<Mailbox>{0x1A, 0x33, "mailbox"};
template <>
inline constexpr Command kCommandOf<MailboxOffset>{0x1A, 0x32, "mailbox offset"};

std::vector<std::uint8_t> payloadOf(Display value);
std::vector<std::uint8_t> payloadOf(PatternSource value);
std::vector<std::uint8_t> payloadOf(TriggerMode value);
std::vector<std::uint8_t> payloadOf(PatternRun value);
std::vector<std::uint8_t> payloadOf(const ExposurePeriod& value);
std::vector<std::uint8_t> payloadOf(const LutControl& value);
/// Sequencer control, whatever `value` says.
std::vector<std::uint8_t> payloadOf(const LedControl& value);
std::vector<std::uint8_t> payloadOf(const TriggerOut1& value);
std::vector<std::uint8_t> payloadOf(const TriggerOut2& value);
std::vector<std::uint8_t> payloadOf(Mailbox value);
std::vector<std::uint8_t> payloadOf(MailboxOffset value);
/// The check of the pattern table is asked for with one byte that means nothing.
std::vector<std::uint8_t> validationRequest();

template <>
Result<Display> parsed<Display>(Data data);
template <>
Result<PatternSource> parsed<PatternSource>(Data data);
template <>
Result<TriggerMode> parsed<TriggerMode>(Data data);
template <>
Result<PatternRun> parsed<PatternRun>(Data data);
template <>
Result<ExposurePeriod> parsed<ExposurePeriod>(Data data);
template <>
Result<LutControl> parsed<LutControl>(Data data);
template <>
Result<LedControl> parsed<LedControl>(Data data);
template <>
Result<TriggerOut1> parsed<TriggerOut1>(Data data);
template <>
Result<TriggerOut2> parsed<TriggerOut2>(Data data);

std::string inWords(Display value);
std::string inWords(PatternSource value);
std::string inWords(TriggerMode value);
std::string inWords(PatternRun value);
std::string inWords(const ExposurePeriod& value);
std::string inWords(const LutControl& value);
std::string inWords(const LedControl& value);
std::string inWords(const TriggerOut1& value);
std::string inWords(const TriggerOut2& value);

}  // namespace ilf::devices::dlpc350
