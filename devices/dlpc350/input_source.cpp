#include "devices/dlpc350/input_source.h"

#include <cassert>

#include "devices/dlpc350/little_endian.h"

namespace ilf::devices::dlpc350 {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kThreeBits = 7;
constexpr unsigned kWidthShift = 3;
constexpr std::uint16_t kFull = 1023;

void append(Bytes& bytes, const TestColour& colour) {
    for (const std::uint16_t value : {colour.red, colour.green, colour.blue}) {
        assert(value <= kFull);
        bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
        bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
    }
}

TestColour colourAt(Data data, std::size_t at) {
    const auto value = [&](std::size_t which) { return static_cast<std::uint16_t>(u16At(data, at + 2 * which)); };
    return {value(0), value(1), value(2)};
}

std::string inWords(const TestColour& colour) {
    return std::to_string(colour.red) + " " + std::to_string(colour.green) + " " + std::to_string(colour.blue);
}

}  // namespace

Bytes payloadOf(const InputSource& value) {
    assert(value.width <= kThreeBits);
    return {static_cast<std::uint8_t>(static_cast<unsigned>(value.source) | unsigned{value.width} << kWidthShift)};
}
Bytes payloadOf(TestPattern value) { return {static_cast<std::uint8_t>(value)}; }
Bytes payloadOf(const TestColours& value) {
    Bytes bytes;
    append(bytes, value.foreground);
    append(bytes, value.background);
    return bytes;
}

template <>
Result<InputSource> parsed<InputSource>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<InputSource>.name, 0, 1);
    const unsigned source = data[0] & kThreeBits;
    if (source > static_cast<unsigned>(Source::fpdLink))
        return fail(Fault::badFile,
                    "The board's input source is " + std::to_string(source) + ", which this program does not know.");
    return InputSource{static_cast<Source>(source), static_cast<std::uint8_t>(data[0] >> kWidthShift & kThreeBits)};
}
template <>
Result<TestPattern> parsed<TestPattern>(Data data) {
    if (data.empty()) return tooShort(kCommandOf<TestPattern>.name, 0, 1);
    if (data[0] > static_cast<std::uint8_t>(TestPattern::stepBars))
        return fail(Fault::badFile,
                    "The board's test pattern is " + std::to_string(data[0]) + ", which this program does not know.");
    return static_cast<TestPattern>(data[0]);
}
template <>
Result<TestColours> parsed<TestColours>(Data data) {
    if (data.size() < 12) return tooShort(kCommandOf<TestColours>.name, data.size(), 12);
    return TestColours{colourAt(data, 0), colourAt(data, 6)};
}

std::string inWords(const InputSource& value) {
    switch (value.source) {
    case Source::parallel:
        return "parallel port";
    case Source::testPattern:
        return "test pattern";
    case Source::flash:
        return "flash";
    case Source::fpdLink:
        return "FPD-link";
    }
    return {};
}
std::string inWords(TestPattern value) {
    return value == TestPattern::solid ? "one colour" : "pattern " + std::to_string(static_cast<int>(value));
}
std::string inWords(const TestColours& value) { return inWords(value.foreground) + " on " + inWords(value.background); }

}  // namespace ilf::devices::dlpc350
