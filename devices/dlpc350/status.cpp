#include "devices/dlpc350/status.h"

#include <algorithm>

#include "core/plan/words.h"
#include "devices/dlpc350/little_endian.h"

namespace ilf::devices::dlpc350 {
namespace {

Release releaseAt(Data data, std::size_t at) {
    const std::uint32_t word = u32At(data, at);
    return {static_cast<int>(word >> 24), static_cast<int>((word >> 16) & 0xFF), static_cast<int>(word & 0xFFFF)};
}

bool bit(std::uint8_t byte, int which) { return ((byte >> which) & 1) != 0; }

}  // namespace

template <>
Result<Version> parsed<Version>(Data data) {
    if (data.size() < 16) return tooShort(kCommandOf<Version>.name, data.size(), 16);
    return Version{releaseAt(data, 0), releaseAt(data, 4), releaseAt(data, 8), releaseAt(data, 12)};
}

template <>
Result<FirmwareTag> parsed<FirmwareTag>(Data data) {
    FirmwareTag tag;
    for (const std::uint8_t c : data.first(std::min<std::size_t>(data.size(), 32))) {
        if (c == 0) break;
        tag.text += c >= 0x20 && c < 0x7F ? static_cast<char>(c) : '?';
    }
    return tag;
}

template <>
Result<HardwareStatus> parsed<HardwareStatus>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<HardwareStatus>.name, 0, 1);
    return HardwareStatus{bit(data[0], 0), bit(data[0], 2), bit(data[0], 3), bit(data[0], 6), bit(data[0], 7)};
}

template <>
Result<SystemStatus> parsed<SystemStatus>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<SystemStatus>.name, 0, 1);
    return SystemStatus{bit(data[0], 0)};
}

template <>
Result<MainStatus> parsed<MainStatus>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<MainStatus>.name, 0, 1);
    return MainStatus{bit(data[0], 0), bit(data[0], 1), bit(data[0], 2), bit(data[0], 3)};
}

template <>
Result<VideoSignal> parsed<VideoSignal>(Data data) {
    constexpr std::size_t kBytes = 28;
    if (data.size() < kBytes) return tooShort(kCommandOf<VideoSignal>.name, data.size(), kBytes);
    constexpr std::uint8_t kStateMask = 3, kLocked = 2;
    return VideoSignal{(data[0] & kStateMask) == kLocked, u16At(data, 1), u16At(data, 3), u16At(data, 14) * 0.01_Hz};
}

template <>
Result<Validation> parsed<Validation>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<Validation>.name, 0, 1);
    const std::uint8_t b = data[0];
    return Validation{bit(b, 7), bit(b, 0), bit(b, 1), bit(b, 2), bit(b, 3), bit(b, 4)};
}

std::string inWords(const Release& release) {
    return std::to_string(release.major) + "." + std::to_string(release.minor) + "." + std::to_string(release.patch);
}

std::string inWords(const VideoSignal& signal) {
    if (!signal.locked) return "no picture locked";
    return std::to_string(signal.width) + "x" + std::to_string(signal.height) + " at " +
           ilf::inWords(signal.refresh.si(), 2) + " Hz";
}

std::vector<std::string> troubles(const HardwareStatus& status) {
    std::vector<std::string> found;
    if (!status.initialised)
        found.emplace_back("The controller did not initialise: switch the projector's power off and on.");
    if (status.drcError) found.emplace_back("The controller reports a DRC error (bit 2): switch its power off and on.");
    if (status.forcedSwap)
        found.emplace_back("Buffers were swapped by force: the exposures do not fit into the frame. Use fewer or "
                           "shorter slots, and check that the video really has the refresh it was measured at.");
    if (status.sequencerAbort)
        found.emplace_back("The sequencer gave up: the exposures do not fit into the frame, or the video stopped. Use "
                           "fewer or shorter slots, and check the video's cable.");
    if (status.sequencerError) found.emplace_back("The sequencer reports an error: start the patterns again.");
    return found;
}

std::vector<std::string> troubles(const SystemStatus& status) {
    if (status.memoryTestPassed) return {};
    return {"The controller's memory test failed: switch the projector's power off and on."};
}

std::vector<std::string> troubles(const MainStatus& status) {
    if (!status.mirrorsParked) return {};
    return {"The mirrors are parked, so nothing is projected: switch the projector's power off and on."};
}

std::vector<std::string> troubles(const Validation& validation) {
    std::vector<std::string> found;
    if (validation.busy) found.emplace_back("The check of the pattern table did not end. Start the patterns again.");
    if (validation.exposureInvalid)
        found.emplace_back("The board calls the exposure or the period invalid: use fewer or longer slots.");
    if (validation.patternNumbersInvalid)
        found.emplace_back("The board calls a pattern number invalid: there are 24 bit planes in a frame. "
                           "Use fewer slots or fewer bits.");
    return found;
}

std::vector<std::string> remarks(const Validation& validation) {
    std::vector<std::string> found;
    if (validation.triggerOverlaps) found.emplace_back("TRIG_OUT_1 stays high between patterns, or overlaps.");
    if (validation.noBlackBeforeTrigger)
        found.emplace_back("No black before an externally triggered pattern (usual for streamed video).");
    if (validation.gapTooShort) found.emplace_back("Less than 230 us between a pattern and the end of its period.");
    return found;
}

std::vector<std::string> remarks(const Version& version) {
    const Release& firmware = version.application;
    const std::string name = "Firmware " + inWords(firmware);
    if (firmware < Release{3, 0, 0}) return {name + " is older than 3.0, which other programs refuse: update it."};
    if (firmware == Release{4, 0, 3}) return {name + " is known for a glitch of its triggers."};
    if (firmware.major == 4 && firmware.minor == 1)
        return {name + " is known to show wrong patterns with more than two buffer swaps in a pattern table."};
    return {};
}

}  // namespace ilf::devices::dlpc350
