// Numbers as operators read them in the planner's sentences.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/quantity.h"

namespace ilf {

/// `value` with `decimals` places.
inline std::string inWords(double value, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}
/// As few digits as say it: 60 Hz, 62.5 Hz.
inline std::string inWords(Hertz rate) {
    char text[64];
    std::snprintf(text, sizeof text, "%.5g Hz", rate.si());
    return text;
}
inline std::string inWords(Dioptre power) { return inWords(power.si(), 2) + " D"; }
/// Millimetre steps.
inline std::string inWords(Metre distance) { return inWords(distance.si(), 3) + " m"; }
/// Millimetre steps, never less than `distance`: for "beyond".
inline std::string inWordsRoundedUp(Metre distance) {
    return inWords(Metre::fromSi(std::ceil(distance.in(1.0_mm)) * 1e-3));
}
inline std::string inQuotes(const std::string& name) { return '"' + name + '"'; }

}  // namespace ilf
