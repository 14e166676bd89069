// What a photodiode's volts mean in dioptres, when light goes through the lens onto it.
#pragma once

#include <span>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::devices {

/// What was heard while the lens stood at a power that is known from elsewhere.
struct VoltsAtPower {
    double volts = 0.0, power_D = 0.0;
};

/// A beam of radius w0 at the lens has the radius w0 |1 - L P| where the photodiode is, L behind the lens. A photodiode
/// smaller than the beam gets light in proportion to 1 / (1 - L P)^2 (the paper's set-up, section 4: laser, lens,
/// photodiode about 5 mm behind it). So 1 / sqrt(volts - dark) is a straight line over P, up to what beam and
/// photodiode are in truth, and that is a smooth bend: P is fitted as a polynomial of it. Neither L nor the radii need
/// be known; the powers must be, at two currents or more, from a lensmeter or the lens's own certificate.
struct PowerScale {
    double dark_V = 0.0;
    double middle = 0.0, span = 1.0;   ///< of 1 / sqrt(volts - dark), over what was known
    std::vector<double> terms;         ///< D, of powers of (1 / sqrt(volts - dark) - middle) / span
    double low_D = 0.0, high_D = 0.0;  ///< powers that were known
    double largestMiss_D = 0.0;        ///< of the known powers
    /// Not a number where there is no light.
    double powerAt(double volts) const;
    /// Volts for each dioptre, at this level.
    double slopeAt(double volts) const;
};

/// Degree 1 with two known powers, 2 with three or four, 3 with more. Refused: fewer than two, light that is not above
/// `dark_V` everywhere, and powers that do not go one way with the light.
Result<PowerScale> powerScale(std::span<const VoltsAtPower> known, double dark_V);

}  // namespace ilf::devices
