// The tunable lens as aperture stop: where its rim, not the pupil, limits the beam.
#pragma once

#include "core/optics/eye.h"

namespace ilf {

/// D_eff = min(D_e, D_ETL N / w), N = w + e - w e P: the part of the pupil that light from an axial point at `distance`
/// reaches through a lens of clear diameter `lensAperture` (the edge ray meets the lens at the height D_eff w / (2 N)).
/// At infinity N / w is 1 - e P. Precondition: e P < 1, distance > 0.
Metre effectivePupil(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens);

/// The lens's rim is the stop: D_ETL N / w < D_e. Never for an eye, nearly always for a fast camera (24 mm F1.4 behind
/// 16 mm), whose blur is then linear in P.
bool lensIsStop(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens);

/// Blur-circle diameter on the retina or sensor with the smaller of the two stops, D_eff d_er |E|, not accommodating.
Metre blurDiameterStopped(const EyeOptics& eye, Metre lensAperture, Metre distance, Dioptre lens);

}  // namespace ilf
