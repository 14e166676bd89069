#include "devices/dlpc350/sequence.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "core/plan/projector.h"
#include "core/plan/words.h"
#include "devices/dlpc350/little_endian.h"
#include "devices/dlpc350/settings.h"

namespace ilf::devices::dlpc350 {
namespace {

/// Exposures are sent in whole microseconds; sums of decimal fractions are not exact.
constexpr Second kSlack = 0.01_us;

std::string bits(int depth) { return std::to_string(depth) + (depth == 1 ? " bit" : " bits"); }
std::string entryName(std::size_t index) { return "Entry " + std::to_string(index) + " of the pattern table "; }
std::string us(Second time) { return ilf::inWords(time.in(1.0_us), 0) + " us"; }

Result<void> checkedEntry(const PatternEntry& entry, std::size_t index) {
    if (entry.depth < 1 || entry.depth > 8)
        return fail(Fault::unsafe, entryName(index) + "has " + bits(entry.depth) + "; pictures have 1 to 8.");
    if (entry.number != kBlackPattern && (entry.number < 0 || entry.number >= patternsAFrame(entry.depth)))
        return fail(Fault::unsafe, entryName(index) + "shows picture " + std::to_string(entry.number) + " of " +
                                       bits(entry.depth) + "; a frame has 24 bit planes, so they count 0 to " +
                                       std::to_string(patternsAFrame(entry.depth) - 1) + ".");
    if (entry.trigger != Trigger::none && entry.trigger != Trigger::externalPositive)
        return fail(Fault::unsafe, entryName(index) + "has a trigger that does not exist with live video: a frame's "
                                                      "first entry follows VSYNC, the others the one before.");
    if (!isFinite(entry.exposure) || entry.exposure < shortestExposure(entry.depth) - kSlack)
        return fail(Fault::unsafe, entryName(index) + "is lit for " + us(entry.exposure) + "; " + bits(entry.depth) +
                                       " take at least " + us(shortestExposure(entry.depth)) +
                                       ". Use fewer bits or fewer slots.");
    return {};
}

/// One frame's entries: their planes and their time.
struct FrameLoad {
    int planes = 0;
    Second time;
};

Result<void> checkedFrame(const FrameLoad& load, std::size_t first, Second frame) {
    const std::string which = "The frame that starts with entry " + std::to_string(first) + " of the pattern table ";
    if (load.planes > kPlanesAFrame)
        return fail(Fault::unsafe, which + "needs " + std::to_string(load.planes) +
                                       " bit planes; there are 24. Use fewer slots or fewer bits.");
    if (load.time > frame + kSlack)
        return fail(Fault::unsafe, which + "is lit for " + us(load.time) + "; the video's frame, as measured, lasts " +
                                       us(frame) + ". Use fewer or shorter slots.");
    return {};
}

}  // namespace

PatternSequence evenSequence(int slots, int depth, Second exposure) {
    PatternSequence sequence;
    for (int i = 0; i < slots; ++i)
        sequence.entries.push_back(
            {depth, i, Led::white, i == 0 ? Trigger::externalPositive : Trigger::none, exposure});
    return sequence;
}

int patternsAFrame(int depth) {
    constexpr std::array<int, 8> kPatterns{24, 12, 8, 6, 4, 4, 3, 3};
    assert(depth >= 1 && depth <= 8);
    return kPatterns[static_cast<std::size_t>(std::clamp(depth, 1, 8) - 1)];
}

Planes planesOf(int depth, int number) {
    // 5 bits lie in the upper five of six planes, 7 in the upper seven of a colour's eight.
    const int step = depth == 5 ? 6 : depth == 7 ? 8 : depth;
    return {number * step + (step - depth), depth};
}

Second shortestExposure(int depth) {
    Rig rig;
    rig.kind = ProjectorKind::lightCrafter4500;
    rig.bits = depth;
    return shortestSlot(rig);
}

double wholeMicroseconds(Second exposure) { return std::floor(exposure.in(1.0_us) + 1e-3); }

Result<void> checkedSequence(const PatternSequence& sequence, Second frame) {
    const auto& entries = sequence.entries;
    if (!isFinite(frame) || frame <= 0.0_s)
        return fail(Fault::unsafe,
                    "The video's refresh is not measured, so no pattern table can be checked against it.");
    if (entries.empty()) return fail(Fault::unsafe, "The pattern table is empty: a sweep needs at least one slot.");
    if (entries.size() > kMostEntries)
        return fail(Fault::unsafe, "The pattern table has " + std::to_string(entries.size()) +
                                       " entries; the board holds 128. Use fewer slots.");
    if (entries.front().trigger != Trigger::externalPositive)
        return fail(Fault::unsafe, "The pattern table's first entry must follow VSYNC, or the board never starts.");

    FrameLoad load;
    std::size_t first = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const PatternEntry& entry = entries[i];
        if (const auto ok = checkedEntry(entry, i); !ok) return ok;
        if (abs(entry.exposure - entries.front().exposure) > kSlack)
            return fail(Fault::unsafe, entryName(i) + "is lit for " + us(entry.exposure) + ", the first for " +
                                           us(entries.front().exposure) +
                                           "; with live video all slots of this projector are equally long.");
        if (entry.trigger == Trigger::externalPositive && i > 0) {
            if (const auto ok = checkedFrame(load, first, frame); !ok) return ok;
            load = {};
            first = i;
        }
        load.planes += entry.number == kBlackPattern ? 0 : entry.depth;
        load.time += wholeMicroseconds(entry.exposure) * 1.0_us;
    }
    return checkedFrame(load, first, frame);
}

std::vector<LutEntry> lutOf(const PatternSequence& sequence, bool swapAtFrame) {
    std::vector<LutEntry> lut;
    for (const PatternEntry& entry : sequence.entries) {
        LutEntry wire;
        wire.trigger = entry.trigger;
        wire.number = entry.number;
        wire.depth = entry.depth;
        wire.led = entry.led;
        wire.bufferSwap = swapAtFrame && entry.trigger == Trigger::externalPositive;
        lut.push_back(wire);
    }
    return lut;
}

std::vector<std::uint8_t> lutBytes(const std::vector<LutEntry>& entries) {
    std::vector<std::uint8_t> bytes;
    for (const LutEntry& entry : entries) {
        assert(entry.number >= 0 && entry.number < 64 && entry.depth >= 1 && entry.depth <= 8);
        bytes.push_back(static_cast<std::uint8_t>(static_cast<int>(entry.trigger) | (entry.number << 2)));
        bytes.push_back(static_cast<std::uint8_t>(entry.depth | (static_cast<int>(entry.led) << 4)));
        bytes.push_back(static_cast<std::uint8_t>((entry.invert ? 1 : 0) | (entry.blackAfter ? 2 : 0) |
                                                  (entry.bufferSwap ? 4 : 0) | (entry.sharesTrigOut1 ? 8 : 0)));
    }
    return bytes;
}

Result<std::vector<LutEntry>> parsedLut(Data data, std::size_t count) {
    if (data.size() < count * 3) return tooShort(kMailboxData.name, data.size(), count * 3);
    std::vector<LutEntry> entries;
    for (std::size_t at = 0; at < count * 3; at += 3) {
        LutEntry entry;
        entry.trigger = static_cast<Trigger>(data[at] & 3);
        entry.number = data[at] >> 2;
        entry.depth = data[at + 1] & 0x0F;
        entry.led = static_cast<Led>((data[at + 1] >> 4) & 7);
        entry.invert = (data[at + 2] & 1) != 0;
        entry.blackAfter = (data[at + 2] & 2) != 0;
        entry.bufferSwap = (data[at + 2] & 4) != 0;
        entry.sharesTrigOut1 = (data[at + 2] & 8) != 0;
        entries.push_back(entry);
    }
    return entries;
}

std::string inWords(const LutEntry& entry) {
    static constexpr std::array<const char*, 4> kTriggers{"internal trigger", "VSYNC", "falling trigger", "no trigger"};
    static constexpr std::array<const char*, 8> kLeds{"dark", "red",          "green",          "red and green",
                                                      "blue", "red and blue", "green and blue", "white"};
    return "picture " + std::to_string(entry.number) + " of " + bits(entry.depth) + ", " +
           kLeds[static_cast<std::size_t>(entry.led) & 7] + ", " +
           kTriggers[static_cast<std::size_t>(entry.trigger) & 3] + (entry.invert ? ", inverted" : "") +
           (entry.blackAfter ? ", black after" : "") + (entry.bufferSwap ? ", buffer swap" : "") +
           (entry.sharesTrigOut1 ? ", shared trigger" : "");
}

}  // namespace ilf::devices::dlpc350
