// Numbers as picture files write them: most significant byte first.
#pragma once

#include <cstdint>
#include <string>

namespace ilf::projects {

inline std::string bigEndian(std::uint32_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i)
        bytes[i] = static_cast<char>(value >> (24 - 8 * i));
    return bytes;
}

}  // namespace ilf::projects
