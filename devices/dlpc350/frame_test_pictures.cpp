#include "devices/dlpc350/frame_test_pictures.h"

#include <array>
#include <cassert>

namespace ilf::devices::dlpc350 {
namespace {

constexpr int kColumns = 6, kRows = 4;
constexpr int kCellWidth = kRaster.width / kColumns, kCellHeight = kRaster.height / kRows;
constexpr int kRim = 4;
constexpr int kDigitWidth = 40, kDigitHeight = 96, kStroke = 12, kBetween = 16;

using Rect = PixelRect<ProjectorFrame>;

std::size_t pixels() { return static_cast<std::size_t>(kRaster.width) * static_cast<std::size_t>(kRaster.height); }

void light(VideoPicture& picture, int plane, const Rect& where) {
    // Red, green, blue in memory; planes count green, red, blue.
    constexpr std::array<std::size_t, 3> kByteOfColour{1, 0, 2};
    const std::size_t byte = kByteOfColour[static_cast<std::size_t>(plane / 8)];
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.size.width) +
                               static_cast<std::size_t>(x);
            std::uint8_t& value = picture.rgb[3 * pixel + byte];
            value = static_cast<std::uint8_t>(value | 1 << plane % 8);
        }
}

void drawRim(VideoPicture& picture, int plane, const Rect& cell) {
    light(picture, plane, {cell.x0, cell.y0, cell.x1, cell.y0 + kRim});
    light(picture, plane, {cell.x0, cell.y1 - kRim, cell.x1, cell.y1});
    light(picture, plane, {cell.x0, cell.y0, cell.x0 + kRim, cell.y1});
    light(picture, plane, {cell.x1 - kRim, cell.y0, cell.x1, cell.y1});
}

/// Seven segments, each a bit: top, upper left, upper right, middle, lower left, lower right, bottom.
void drawDigit(VideoPicture& picture, int plane, int digit, int x, int y) {
    constexpr std::array<unsigned, 10> kSegments{0b1110111, 0b0100100, 0b1011101, 0b1101101, 0b0101110,
                                                 0b1101011, 0b1111011, 0b0100101, 0b1111111, 0b1101111};
    constexpr int kRight = kDigitWidth - kStroke, kHalf = kDigitHeight / 2;
    constexpr int kMiddle = kHalf - kStroke / 2, kLow = kDigitHeight - kStroke;
    constexpr std::array<Rect, 7> kWhere{
        Rect{0, 0, kDigitWidth, kStroke},        Rect{0, 0, kStroke, kHalf},
        Rect{kRight, 0, kDigitWidth, kHalf},     Rect{0, kMiddle, kDigitWidth, kMiddle + kStroke},
        Rect{0, kHalf, kStroke, kDigitHeight},   Rect{kRight, kHalf, kDigitWidth, kDigitHeight},
        Rect{0, kLow, kDigitWidth, kDigitHeight}};
    for (std::size_t i = 0; i < kWhere.size(); ++i) {
        const Rect& part = kWhere[i];
        if ((kSegments[static_cast<std::size_t>(digit)] >> i & 1U) != 0)
            light(picture, plane, {x + part.x0, y + part.y0, x + part.x1, y + part.y1});
    }
}

}  // namespace

VideoPicture whitePicture() { return {kRaster, std::vector<std::uint8_t>(3 * pixels(), 255)}; }

PixelRect<ProjectorFrame> identificationCell(int plane) {
    assert(plane >= 0 && plane < kPlanesAFrame);
    const int x = plane % kColumns * kCellWidth, y = plane / kColumns * kCellHeight;
    return {x, y, x + kCellWidth, y + kCellHeight};
}

PackedFrame identificationFrame() {
    PackedFrame frame{{kRaster, std::vector<std::uint8_t>(3 * pixels(), 0)},
                      evenSequence(kPlanesAFrame, 1, (1.0 / 60.0_Hz) / kPlanesAFrame),
                      1};
    for (int plane = 0; plane < kPlanesAFrame; ++plane) {
        const Rect cell = identificationCell(plane);
        drawRim(frame.picture, plane, cell);
        const int width = plane < 10 ? kDigitWidth : 2 * kDigitWidth + kBetween;
        const int x = (cell.x0 + cell.x1 - width) / 2, y = (cell.y0 + cell.y1 - kDigitHeight) / 2;
        if (plane >= 10) drawDigit(frame.picture, plane, plane / 10, x, y);
        drawDigit(frame.picture, plane, plane % 10, x + width - kDigitWidth, y);
    }
    return frame;
}

PatternSequence onlyPlane(int plane, Second exposure) {
    PatternSequence sequence = evenSequence(1, 1, exposure);
    sequence.entries.front().number = plane;
    return sequence;
}

}  // namespace ilf::devices::dlpc350
