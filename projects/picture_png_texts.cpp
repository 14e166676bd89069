#include "projects/picture_png_texts.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "projects/big_endian.h"

namespace ilf::projects {
namespace {

/// CRC-32 as PNG has it (ISO 3309), bit by bit: texts are short.
std::uint32_t crc(const std::string& bytes) {
    std::uint32_t value = 0xffffffffU;
    for (const char c : bytes) {
        value ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            value = (value >> 1U) ^ ((value & 1U) != 0 ? 0xedb88320U : 0U);
    }
    return ~value;
}

std::string chunk(const std::string& type, const std::string& content) {
    return bigEndian(static_cast<std::uint32_t>(content.size())) + type + content + bigEndian(crc(type + content));
}

bool isAscii(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

}  // namespace

std::string withFacts(const std::string& png, const PictureFacts& facts, bool srgb) {
    constexpr std::size_t kHeader = 33;  // signature and IHDR, which must come first
    assert(png.size() > kHeader);
    std::string added;
    if (srgb) added += chunk("sRGB", std::string(1, '\0'));  // perceptual
    for (const auto& [key, value] : facts)
        added += isAscii(value)
                     ? chunk("tEXt", key + '\0' + value)
                     : chunk("iTXt", key + std::string(5, '\0') + value);  // UTF-8, of no language, uncompressed
    return png.substr(0, kHeader) + added + png.substr(kHeader);
}

}  // namespace ilf::projects
