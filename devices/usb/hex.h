// Numbers as USB tools write them.
#pragma once

#include <cstdio>
#include <string>

namespace ilf::devices {

/// `value` in at least `digits` hexadecimal digits.
inline std::string hex(unsigned value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*X", digits, value);
    return text;
}

}  // namespace ilf::devices
