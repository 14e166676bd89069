#include "core/optics/pupil.h"

#include <cmath>
#include <numbers>

namespace ilf {

double roundField_deg2(double degrees) { return std::numbers::pi * 0.25 * degrees * degrees; }

Result<Metre> pupilInLight(const AdaptingLight& light, double ageYears) {
    if (!(light.luminance >= 0.0) || !(light.fieldArea_deg2 >= 0.0) ||
        !std::isfinite(light.luminance * light.fieldArea_deg2)) {
        return fail(Fault::outOfRange, "A pupil needs a luminance and a field of at least 0 to adapt to.");
    }
    if (light.eyes != 1 && light.eyes != 2) return fail(Fault::outOfRange, "A wearer looks with one eye or with two.");
    if (!(ageYears >= 1.0 && ageYears <= 120.0)) {
        return fail(Fault::outOfRange, "A pupil is known for ages of 1 to 120 years.");
    }
    const double monocular = light.eyes == 2 ? 1.0 : 0.1;
    const double f = std::pow(light.luminance * light.fieldArea_deg2 * monocular / 846.0, 0.41);
    const double young = 7.75 - 5.75 * f / (f + 2.0);
    const double millimetres = young + (ageYears - 28.58) * (0.02132 - 0.009562 * young);
    return Metre::fromSi(1e-3 * millimetres);
}

}  // namespace ilf
