// A camera or an eye behind the tunable lens as ray matrices see it: pictures of dots and rings, ray by ray.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/lens/harmonics.h"

namespace ilf::app {

/// Thin lenses and stops on one axis; nothing of the closed forms.
struct TracedCamera {
    Metre lensToPupil = 20.0_mm;
    Metre lensAperture = 16.0_mm;  ///< of the tunable lens
    Metre pupil;                   ///< of the camera's own lens, or the eye's
    Dioptre ownPower;              ///< of the camera's own lens, or the eye's
    Metre sensor;                  ///< behind its own lens
    Metre pixelPitch;
};

/// A camera lens of `focalLength` whose sensor lies where it is sharp at `distance` with the tunable lens at 0 D.
TracedCamera focusedCamera(Metre focalLength, double fNumber, Metre pixelPitch, Metre distance, Metre lensToPupil,
                           Metre lensAperture);

/// The reduced eye, 60 D, with receptors `pitch` apart. It accommodates by up to `amplitude` to what lies at `distance`
/// behind the tunable lens at `lens`.
TracedCamera accommodatedEye(Metre pupil, Metre lensToPupil, Dioptre amplitude, Metre pitch, Metre distance,
                             Dioptre lens);

/// Powers of the lens while light falls, equally spaced in time; one of them for a lens at rest.
std::vector<double> heldPower(Dioptre power);
/// `length` and `middle` in sweeps.
std::vector<double> sweptPowers(const Harmonics& power, double middle, double length, int samples);

/// Three by three bright dots on a dark surface, the middle one on the axis.
struct DotChart {
    Metre distance;
    Metre spacing, dotRadius;
};
/// What the sensor collects, in light per pixel: `rays` of each dot, spread evenly over lens, dot and time.
Image<float> picturedDots(const TracedCamera& camera, const DotChart& chart, std::span<const double> powers,
                          Size sensor, int rays);

/// A Landolt ring: black on white, gap and stroke a fifth of its diameter.
struct LandoltRing {
    Metre distance;
    Metre gap;
    int direction = 0;  ///< of `kRingDirections`, counterclockwise from the right
};
inline constexpr int kRingDirections = 8;
/// Upright, the ring in the middle, 1 where all is white; `rays` for each pixel, through the pupil alone (the lens is
/// the wider).
Image<float> picturedRing(const TracedCamera& camera, const LandoltRing& ring, std::span<const double> powers,
                          Size sensor, int rays);

}  // namespace ilf::app
