// What the DLPC350 shows within one video frame: patterns in the order of time, and what its tables allow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "devices/dlpc350/messages.h"

namespace ilf::devices::dlpc350 {

enum class Led : std::uint8_t { dark = 0, red = 1, green = 2, yellow = 3, blue = 4, magenta = 5, cyan = 6, white = 7 };
enum class Trigger : std::uint8_t {
    internal = 0,
    externalPositive = 1,
    externalNegative = 2,
    none = 3,  ///< goes on from the pattern before
};

/// The pattern number of black, which takes no bit plane.
inline constexpr int kBlackPattern = 24;
inline constexpr int kPlanesAFrame = 24;
inline constexpr int kMostEntries = 128;

/// One pattern. `number` counts the pictures of its depth within a frame: `planesOf` says which bits they take.
struct PatternEntry {
    int depth = 1;  ///< bits, 1 ... 8
    int number = 0;
    Led led = Led::white;
    Trigger trigger = Trigger::none;
    Second exposure = 694.0_us;
    bool operator==(const PatternEntry&) const = default;
};

/// Patterns in the order they are shown. A frame starts with each entry whose trigger is externalPositive (VSYNC).
struct PatternSequence {
    std::vector<PatternEntry> entries;
    bool operator==(const PatternSequence&) const = default;
};

/// One frame of `slots` white patterns of `depth` bits, in the order of their numbers.
PatternSequence evenSequence(int slots, int depth, Second exposure);

/// Pictures of `depth` bits in a frame: 24, 12, 8, 6, 4, 4, 3, 3.
int patternsAFrame(int depth);

/// The bit planes a pattern takes, least significant first. Planes of an RGB888 frame count 0-7 = G0...G7,
/// 8-15 = R0...R7, 16-23 = B0...B7. Source: TI's pattern list and its users' tables (devices 1.5); the order was never
/// seen on a board here, which is what the plane-identification picture is for.
struct Planes {
    int first = 0, count = 0;
    bool operator==(const Planes&) const = default;
};
Planes planesOf(int depth, int number);

/// The shortest a pattern of `depth` bits may be shown when it comes from video (core/plan/projector.h, of this kind).
Second shortestExposure(int depth);

/// Refuses what the tables forbid, in words: no or more than 128 entries, a first entry without trigger, depths,
/// numbers or triggers that do not exist, exposures that differ, are too short for their depth or do not fit into a
/// frame of length `frame` (measured), more than 24 bit planes in a frame.
Result<void> checkedSequence(const PatternSequence& sequence, Second frame);

/// As the board is told an exposure: rounded down, so that all of a frame still fit into it; not below a whole number
/// written as a fraction.
double wholeMicroseconds(Second exposure);

/// How an entry travels: three bytes of the pattern table.
struct LutEntry {
    Trigger trigger = Trigger::none;
    int number = 0, depth = 1;
    Led led = Led::white;
    bool invert = false, blackAfter = false, bufferSwap = false, sharesTrigOut1 = false;
    bool operator==(const LutEntry&) const = default;
};

/// TI's own program swaps buffers at each frame's first pattern; one community driver never sets the bit and works as
/// well, its users say. `swapAtFrame` chooses, for first light.
std::vector<LutEntry> lutOf(const PatternSequence& sequence, bool swapAtFrame);
std::vector<std::uint8_t> lutBytes(const std::vector<LutEntry>& entries);
/// The first `count` entries of what was read back.
Result<std::vector<LutEntry>> parsedLut(Data data, std::size_t count);
std::string inWords(const LutEntry& entry);

}  // namespace ilf::devices::dlpc350
