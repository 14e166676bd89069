#include "core/optics/chromatic.h"

#include <string>

namespace ilf {

Result<Dioptre> chromaticRefraction(Metre wavelength) {
    const double um = wavelength.in(1.0_um);
    if (!(um >= 0.380 && um <= 0.780)) {
        return fail(Fault::outOfRange, "The eye's focus is known for light of 380 to 780 nm, not for " +
                                           std::to_string(wavelength.in(1e-9_m)) + " nm.");
    }
    return Dioptre::fromSi(1.7312 - 0.63346 / (um - 0.21410));
}

Result<EyeOptics> inLightOf(EyeOptics eye, Metre wavelength, Metre refractedAt) {
    const auto here = chromaticRefraction(wavelength), there = chromaticRefraction(refractedAt);
    if (!here) return tl::unexpected(here.error());
    if (!there) return tl::unexpected(there.error());
    eye.ametropia += *here - *there;
    return eye;
}

}  // namespace ilf
