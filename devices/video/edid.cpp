#include "devices/video/edid.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <string>

namespace ilf::devices {
namespace {

constexpr std::size_t kBlock = 128;
constexpr std::array<std::uint8_t, 8> kHeader{0x00, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00};
constexpr std::uint8_t kSerialText = 0xff, kNameText = 0xfc;

/// The text descriptor of this kind among the four of 18 bytes at 54; text ends at a line feed and is padded by spaces.
std::string textOf(std::span<const std::uint8_t> edid, std::uint8_t kind) {
    for (std::size_t at = 54; at + 18 <= 126; at += 18) {
        if (edid[at] != 0 || edid[at + 1] != 0 || edid[at + 2] != 0 || edid[at + 3] != kind) continue;
        std::string text;
        for (std::size_t i = at + 5; i < at + 18 && edid[i] != 0x0a; ++i)
            text += edid[i] >= 0x20 && edid[i] < 0x7f ? static_cast<char>(edid[i]) : '?';
        while (!text.empty() && text.back() == ' ')
            text.pop_back();
        return text;
    }
    return {};
}

std::string makerOf(unsigned packed) {
    std::string letters;
    for (const unsigned shift : {10U, 5U, 0U}) {
        const unsigned letter = (packed >> shift) & 31U;
        if (letter < 1 || letter > 26) return {};
        letters += static_cast<char>('A' + static_cast<int>(letter) - 1);
    }
    return letters;
}

}  // namespace

DisplayIdentity identityFromEdid(std::span<const std::uint8_t> edid) {
    if (edid.size() < kBlock || !std::equal(kHeader.begin(), kHeader.end(), edid.begin())) return {};
    const auto block = edid.first(kBlock);
    if (std::accumulate(block.begin(), block.end(), 0U) % 256U != 0) return {};

    DisplayIdentity identity;
    identity.maker = makerOf(static_cast<unsigned>(edid[8]) << 8U | edid[9]);
    identity.model = textOf(block, kNameText);
    if (identity.model.empty()) {
        std::array<char, 8> code{};
        std::snprintf(code.data(), code.size(), "0x%04X", edid[10] | edid[11] << 8);
        identity.model = code.data();
    }
    identity.serial = textOf(block, kSerialText);
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
        number |= static_cast<std::uint32_t>(edid[12 + i]) << (8U * i);
    if (identity.serial.empty() && number != 0) identity.serial = std::to_string(number);
    return identity;
}

}  // namespace ilf::devices
