// Which picture a DLPC350 shows in video mode: what comes in, or one it makes by itself.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/dlpc350/status.h"

namespace ilf::devices::dlpc350 {

// Commands, numbers and layouts: comments of TI's LightCrafter 4500 GUI (dlpc350_api.cpp), which were read. What they
// look like on a projector was not tried.

enum class Source : std::uint8_t {
    parallel = 0,  ///< where the board's HDMI receiver is wired
    testPattern = 1,
    flash = 2,
    fpdLink = 3,
};

/// Bits 2:0, and the parallel port's width in bits 5:3, of which only its code is kept: whoever goes back to video
/// must find it as it was.
struct InputSource {
    Source source = Source::parallel;
    std::uint8_t width = 1;  ///< 0 ... 7; 1: 24 bits
    bool operator==(const InputSource&) const = default;
};

/// What the board draws where `Source::testPattern` is chosen. Only `solid`, the foreground's colour everywhere, is
/// told; all are read.
enum class TestPattern : std::uint8_t {
    solid = 0,
    horizontalRamp,
    verticalRamp,
    horizontalLines,
    diagonalLines,
    verticalLines,
    grid,
    checkerboard,
    rgbRamp,
    colourBars,
    stepBars = 0x0A,
};

struct TestColour {
    std::uint16_t red = 0, green = 0, blue = 0;  ///< 0 ... 1023
    bool operator==(const TestColour&) const = default;
};
struct TestColours {
    TestColour foreground, background;
    bool operator==(const TestColours&) const = default;
};
/// In both, so that no pattern of two colours has another one.
inline constexpr TestColours kTestWhite{{1023, 1023, 1023}, {1023, 1023, 1023}};

template <>
inline constexpr Command kCommandOf<InputSource>{0x1A, 0x00, "input source"};
template <>
inline constexpr Command kCommandOf<TestPattern>{0x12, 0x03, "test pattern"};
template <>
inline constexpr Command kCommandOf<TestColours>{0x12, 0x04, "test pattern's colours"};

std::vector<std::uint8_t> payloadOf(const InputSource& value);
std::vector<std::uint8_t> payloadOf(TestPattern value);
/// Red, green, blue of the foreground, then of the background, two bytes each.
std::vector<std::uint8_t> payloadOf(const TestColours& value);

template <>
Result<InputSource> parsed<InputSource>(Data data);
template <>
Result<TestPattern> parsed<TestPattern>(Data data);
template <>
Result<TestColours> parsed<TestColours>(Data data);

std::string inWords(const InputSource& value);
std::string inWords(TestPattern value);
std::string inWords(const TestColours& value);

}  // namespace ilf::devices::dlpc350
