// Numbers with units as text: what an operator may type into a field, and how a value is written there.
#pragma once

#include <string>
#include <string_view>

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::ui {

/// What a field holds; it decides which units may be typed and which one a bare number means.
enum class Unit {
    metre,       ///< distances: m, cm, mm, um, km; also dioptres (2 dpt = 0.5 m)
    millimetre,  ///< lengths at the eye or across a surface; a bare number is millimetres
    dioptre,     ///< powers: D, dpt; also a focal length (0.5 m = 2 D)
    degree,      ///< angles: deg, rad
    hertz,
    millisecond,
    year,
    pixel,
    percent,  ///< 0..1 inside, 0..100 % as text
    number,   ///< no unit
};

/// `text` in the SI unit of `unit` (metres, dioptres, degrees, hertz, seconds, years, pixels, a share of 1). Takes a
/// decimal comma, "1,5 m", and spaces. Refuses with a sentence that names what can be typed.
Result<double> parsed(std::string_view text, Unit unit);
/// As `parsed`, and refuses what lies outside [low, high] (SI), naming the range.
Result<double> parsedWithin(std::string_view text, Unit unit, double low, double high);

/// The text of a value: the unit an operator would choose ("0.50 m", "2.07 D", "25.6 um"), never more digits than mean
/// something. `parsed(formatted(v))` is v up to the digits shown.
std::string formatted(double si, Unit unit);

inline std::string formatted(Metre v) { return formatted(v.si(), Unit::metre); }
inline std::string formatted(Dioptre v) { return formatted(v.si(), Unit::dioptre); }

}  // namespace ilf::ui
