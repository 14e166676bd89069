#include "devices/emulators/bit_planes.h"

#include <cassert>
#include <cmath>
#include <cstddef>

namespace ilf::devices::emulators {

namespace {

constexpr int kBlack = 24, kWhite = 25;

/// The frame's pixel that a mirror shows. A picture of another size is spread over the mirrors, nearest pixel first.
struct Source {
    const LightSlot& slot;

    std::size_t at(int column, int row) const {
        if (slot.mirrors.flipColumns) column = kMirrorColumns - 1 - column;
        if (slot.mirrors.flipRows) row = kMirrorRows - 1 - row;
        const VideoFrame& frame = *slot.frame;
        if (frame.width != kMirrorColumns) column = int(std::int64_t(column) * frame.width / kMirrorColumns);
        if (frame.height != kMirrorRows) row = int(std::int64_t(row) * frame.height / kMirrorRows);
        return 3 * (std::size_t(row) * std::size_t(frame.width) + std::size_t(column));
    }
    /// Bit n is plane n.
    std::uint32_t planes(std::size_t pixel) const {
        const std::uint8_t* rgb = slot.frame->rgb.data() + pixel;
        const std::uint32_t red = rgb[slot.mirrors.swapsChannels ? 1 : 0];
        const std::uint32_t green = rgb[slot.mirrors.swapsChannels ? 0 : 1];
        return green | red << 8U | std::uint32_t(rgb[2]) << 16U;
    }
    int sum(std::size_t pixel) const {
        const std::uint8_t* rgb = slot.frame->rgb.data() + pixel;
        return rgb[0] + rgb[1] + rgb[2];
    }
};

constexpr int kFullSum = 3 * 255;

/// The light of three colours' sum as video.
std::uint8_t greyOf(int sum, double gamma) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::pow(double(sum) / kFullSum, gamma)));
}

/// The code of every mirror, or nothing where it depends on the frame.
std::optional<int> uniform(const LightSlot& slot) {
    if (slot.leds == 0) return 0;
    if (slot.video) return slot.frame ? std::nullopt : std::optional<int>(0);
    std::optional<int> code;
    if (slot.pattern == kWhite && slot.depth == 1)
        code = 1;
    else if (slot.pattern == kBlack || !lowestPlane(slot.depth, slot.pattern) || !slot.frame)
        code = 0;
    if (code && slot.inverted) code = slot.full() - *code;
    return code;
}

std::uint8_t codeOf(const LightSlot& slot, const Source& source, std::size_t pixel, unsigned lowest, unsigned mask) {
    const std::uint32_t code = source.planes(pixel) >> lowest & mask;
    return static_cast<std::uint8_t>(slot.inverted ? mask - code : code);
}

}  // namespace

int patternCount(int depth) {
    switch (depth) {
    case 1:
        return 24;
    case 2:
        return 12;
    case 3:
        return 8;
    case 4:
        return 6;
    case 5:
        return 4;
    case 6:
        return 4;
    case 7:
        return 3;
    case 8:
        return 3;
    default:
        return 0;
    }
}

std::optional<int> lowestPlane(int depth, int number) {
    if (number < 0 || number >= patternCount(depth)) return std::nullopt;
    // Five bits do not divide a byte: G5-1, R3-0 with G7, B1-0 with R7-5, B7-3. Seven leave the lowest bit out.
    static constexpr int fives[] = {1, 7, 13, 19};
    if (depth == 5) return fives[number];
    if (depth == 7) return 8 * number + 1;
    return depth * number;
}

int LightSlot::codeAt(int column, int row) const {
    assert(column >= 0 && column < kMirrorColumns && row >= 0 && row < kMirrorRows);
    if (const auto code = uniform(*this)) return *code;
    const Source source{*this};
    if (video) return greyOf(source.sum(source.at(column, row)), gamma);
    const auto lowest = static_cast<unsigned>(lowestPlane(depth, pattern).value_or(0));
    return codeOf(*this, source, source.at(column, row), lowest, static_cast<unsigned>(full()));
}

std::vector<std::uint8_t> LightSlot::codes() const {
    std::vector<std::uint8_t> made(std::size_t(kMirrorColumns) * kMirrorRows);
    if (const auto code = uniform(*this)) {
        made.assign(made.size(), static_cast<std::uint8_t>(*code));
        return made;
    }
    const Source source{*this};
    const auto lowest = static_cast<unsigned>(lowestPlane(depth, pattern).value_or(0));
    const auto mask = static_cast<unsigned>(full());
    std::vector<std::uint8_t> greys;
    for (int sum = 0; video && sum <= kFullSum; ++sum)
        greys.push_back(greyOf(sum, gamma));
    std::size_t next = 0;
    for (int row = 0; row < kMirrorRows; ++row)
        for (int column = 0; column < kMirrorColumns; ++column)
            made[next++] = video ? greys[std::size_t(source.sum(source.at(column, row)))]
                                 : codeOf(*this, source, source.at(column, row), lowest, mask);
    return made;
}

std::vector<std::uint8_t> LightSlot::light() const {
    std::vector<std::uint8_t> made = codes();
    std::uint8_t levels[256] = {};
    for (int code = 0; code <= full(); ++code)
        levels[code] = static_cast<std::uint8_t>(std::lround(255.0 * code / full()));
    for (std::uint8_t& value : made)
        value = levels[value];
    return made;
}

}  // namespace ilf::devices::emulators
