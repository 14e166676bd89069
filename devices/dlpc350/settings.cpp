#include "devices/dlpc350/settings.h"

#include <algorithm>
#include <cassert>
#include <cstdio>

#include "devices/dlpc350/little_endian.h"

namespace ilf::devices::dlpc350 {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kSequencerSwitchesLeds = 0x08;

std::string hex(std::uint8_t byte) {
    char text[8];
    std::snprintf(text, sizeof text, "0x%02X", byte);
    return text;
}

/// A setting of one byte, of which only `mask` counts and `known` values are understood.
template <class T>
Result<T> choice(Data data, std::uint8_t mask, std::initializer_list<T> known) {
    if (data.empty()) return tooShort(kCommandOf<T>.name, 0, 1);
    for (const T value : known)
        if (static_cast<std::uint8_t>(value) == (data[0] & mask)) return value;
    return fail(Fault::badFile, std::string("The board's ") + kCommandOf<T>.name + " is " + hex(data[0]) +
                                    ", which this program does not know.");
}

std::uint8_t lessOne(int count, int most) {
    assert(count >= 1 && count <= most);
    return static_cast<std::uint8_t>(std::clamp(count, 1, most) - 1);
}

}  // namespace

Bytes payloadOf(Display value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(PatternSource value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(TriggerMode value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(PatternRun value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(const ExposurePeriod& value) {
    Bytes bytes;
    appendU32(bytes, value.exposure_us);
    appendU32(bytes, value.period_us);
    return bytes;
}
Bytes payloadOf(const LutControl& value) {
    return {lessOne(value.entries, 128), static_cast<std::uint8_t>(value.repeat ? 1 : 0),
            lessOne(value.perTrigOut2, 256), lessOne(value.images, 64)};
}
Bytes payloadOf(const LedControl&) { return {kSequencerSwitchesLeds}; }
Bytes payloadOf(const TriggerOut1& value) { return {value.polarity, value.risingDelay, value.fallingDelay}; }
Bytes payloadOf(const TriggerOut2& value) { return {value.polarity, value.risingDelay}; }
Bytes payloadOf(Mailbox value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(MailboxOffset value) {
    assert(value.entry < 128);
    return {value.entry};
}
Bytes validationRequest() { return {0}; }

template <>
Result<Display> parsed<Display>(Data data) {
    return choice<Display>(data, 0x01, {Display::video, Display::pattern});
}
template <>
Result<PatternSource> parsed<PatternSource>(Data data) {
    return choice<PatternSource>(data, 0x03, {PatternSource::videoPort, PatternSource::flash});
}
template <>
Result<TriggerMode> parsed<TriggerMode>(Data data) {
    return choice<TriggerMode>(data, 0x07,
                               {TriggerMode::vsync, TriggerMode::triggerIn1, TriggerMode::triggerIn1And2,
                                TriggerMode::variableTriggerIn1, TriggerMode::variableVsync});
}
template <>
Result<PatternRun> parsed<PatternRun>(Data data) {
    return choice<PatternRun>(data, 0x03, {PatternRun::stopped, PatternRun::paused, PatternRun::running});
}
template <>
Result<ExposurePeriod> parsed<ExposurePeriod>(Data data) {
    if (data.size() < 8) return tooShort(kCommandOf<ExposurePeriod>.name, data.size(), 8);
    return ExposurePeriod{u32At(data, 0), u32At(data, 4)};
}
template <>
Result<LutControl> parsed<LutControl>(Data data) {
    if (data.size() < 4) return tooShort(kCommandOf<LutControl>.name, data.size(), 4);
    return LutControl{data[0] + 1, data[1] != 0, data[2] + 1, data[3] + 1};
}
template <>
Result<LedControl> parsed<LedControl>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<LedControl>.name, 0, 1);
    return LedControl{(data[0] & kSequencerSwitchesLeds) != 0, (data[0] & 1) != 0, (data[0] & 2) != 0,
                      (data[0] & 4) != 0};
}
template <>
Result<TriggerOut1> parsed<TriggerOut1>(Data data) {
    if (data.size() < 3) return tooShort(kCommandOf<TriggerOut1>.name, data.size(), 3);
    return TriggerOut1{data[0], data[1], data[2]};
}
template <>
Result<TriggerOut2> parsed<TriggerOut2>(Data data) {
    if (data.size() < 2) return tooShort(kCommandOf<TriggerOut2>.name, data.size(), 2);
    return TriggerOut2{data[0], data[1]};
}

std::string inWords(Display value) { return value == Display::video ? "video" : "pattern"; }
std::string inWords(PatternSource value) { return value == PatternSource::videoPort ? "video port" : "flash"; }
std::string inWords(TriggerMode value) {
    switch (value) {
    case TriggerMode::vsync:
        return "VSYNC";
    case TriggerMode::triggerIn1:
        return "TRIG_IN_1";
    case TriggerMode::triggerIn1And2:
        return "TRIG_IN_1 and TRIG_IN_2";
    case TriggerMode::variableTriggerIn1:
        return "TRIG_IN_1 with exposures of their own";
    case TriggerMode::variableVsync:
        return "VSYNC with exposures of their own";
    }
    return {};
}
std::string inWords(PatternRun value) {
    return value == PatternRun::stopped ? "stopped" : value == PatternRun::paused ? "paused" : "running";
}
std::string inWords(const ExposurePeriod& value) {
    return std::to_string(value.exposure_us) + " us of " + std::to_string(value.period_us) + " us";
}
std::string inWords(const LutControl& value) {
    return std::to_string(value.entries) + (value.entries == 1 ? " entry, " : " entries, ") +
           (value.repeat ? "repeated" : "once") + ", TRIG_OUT_2 every " + std::to_string(value.perTrigOut2) + ", " +
           std::to_string(value.images) + (value.images == 1 ? " image" : " images");
}
std::string inWords(const LedControl& value) {
    if (value.sequencer) return "the sequencer";
    std::string on;
    if (value.red) on += " red";
    if (value.green) on += " green";
    if (value.blue) on += " blue";
    return on.empty() ? "by hand, all off" : "by hand, on:" + on;
}
std::string inWords(const TriggerOut1& value) {
    return "polarity " + hex(value.polarity) + ", delays " + hex(value.risingDelay) + " and " + hex(value.fallingDelay);
}
std::string inWords(const TriggerOut2& value) {
    return "polarity " + hex(value.polarity) + ", delay " + hex(value.risingDelay);
}

}  // namespace ilf::devices::dlpc350
