// Colour and focus: the eye's refraction differs by more than a dioptre between blue and red light.
#pragma once

#include "core/base/result.h"
#include "core/optics/eye.h"

namespace ilf {

/// The eye's refraction in light of one wavelength against that at 580 nm:
///
///     Rx = 1.7312 - 0.63346 / (lambda - 0.21410)    D, lambda in um
///
/// Negative (myopic) in blue: -0.85 D at 460 nm, +0.19 D at 625 nm. Refused outside 380 to 780 nm. Source: Thibos, Ye,
/// Zhang and Bradley, "The chromatic eye", Applied Optics 31(19), 1992.
Result<Dioptre> chromaticRefraction(Metre wavelength);

/// The same eye in light of one wavelength, for one whose ametropia holds at `refractedAt`: F0, and with it the far
/// border's F = F0 + b, shifts by Rx(wavelength) - Rx(refractedAt). In blue light objects blur at less power than in
/// red. Of an eye; a camera's lens is corrected for colour.
Result<EyeOptics> inLightOf(EyeOptics eye, Metre wavelength, Metre refractedAt = 580e-9_m);

}  // namespace ilf
