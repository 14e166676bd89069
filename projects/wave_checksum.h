// SHA-256 (FIPS 180-4), which tells a damaged wave from a sound one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ilf::projects {

/// Fed piece by piece; `value` ends it.
class Sha256 {
public:
    void add(std::string_view bytes);
    std::array<std::uint8_t, 32> value();

private:
    void block(const std::uint8_t* bytes);

    std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::uint8_t, 64> rest_{};
    std::size_t resting_ = 0;
    std::uint64_t length_ = 0;
};

}  // namespace ilf::projects
