// A number as text, by a printf pattern.
#pragma once

#include <cstdio>
#include <string>

namespace ilf {

/// `format` takes one double: "%.2f", "%+.1f ppm".
inline std::string asText(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace ilf
