// How wide the pupil opens in a given light, by age: the unified formula of Watson and Yellott.
#pragma once

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf {

/// The light an eye adapts to.
struct AdaptingLight {
    double luminance = 10.0;     ///< cd/m^2, mean over the field and over a sweep
    double fieldArea_deg2 = 0.;  ///< of the lit field, square degrees of visual angle
    int eyes = 2;                ///< that see it: 1 or 2; one eye counts a tenth
    bool operator==(const AdaptingLight&) const = default;
};

/// A round field `degrees` across, in square degrees.
double roundField_deg2(double degrees);

/// Entrance pupil diameter.
///
///     D   = D_SD + (age - 28.58) (0.02132 - 0.009562 D_SD)          mm, age in years
///     D_SD = 7.75 - 5.75 F / (F + 2),   F = (L a e / 846)^0.41      L cd/m^2, a deg^2, e = 1 (two eyes) or 0.1
///
/// Fitted to ages of 20 to 83 years and luminances up to 10^4 cd/m^2; a single person may differ by a millimetre.
/// Darkness is a luminance like others (F = 0). Refused: negative or non-finite light, eyes other than 1 or 2, ages
/// outside 1 to 120 years. Source: Watson and Yellott, "A unified formula for light-adapted pupil size", Journal of
/// Vision 12(10), 2012.
Result<Metre> pupilInLight(const AdaptingLight& light, double ageYears);

}  // namespace ilf
