// What displays say of themselves, made up for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ilf::test {

/// Maker Texas Instruments (TXN: 20, 24, 14 in five bits each), product 0x4500, with both text descriptors.
inline std::vector<std::uint8_t> edid(const std::string& name, const std::string& serial, std::uint32_t number) {
    std::vector<std::uint8_t> bytes(128, 0);
    for (std::size_t i = 1; i < 7; ++i)
        bytes[i] = 0xff;
    bytes[8] = 0x53;
    bytes[9] = 0x0e;
    bytes[10] = 0x00;
    bytes[11] = 0x45;
    for (std::size_t i = 0; i < 4; ++i)
        bytes[12 + i] = static_cast<std::uint8_t>(number >> (8U * i));
    const auto text = [&](std::size_t at, std::uint8_t kind, const std::string& what) {
        bytes[at + 3] = kind;
        for (std::size_t i = 0; i < 13; ++i)
            bytes[at + 5 + i] = static_cast<std::uint8_t>(i < what.size() ? what[i] : i == what.size() ? '\n' : ' ');
    };
    bytes[54] = 1;  // the first descriptor is a timing
    if (!name.empty()) text(72, 0xfc, name);
    if (!serial.empty()) text(90, 0xff, serial);
    unsigned sum = 0;
    for (const std::uint8_t byte : bytes)
        sum += byte;
    bytes[127] = static_cast<std::uint8_t>(256U - sum % 256U);
    return bytes;
}

}  // namespace ilf::test
