// Where magnification has its centre, and how large it is, for a decentred lens, a turned eye or a camera.
#pragma once

#include "core/optics/eye.h"

namespace ilf {

/// From the entrance pupil back to the eye's centre of rotation. Assumed (anatomy varies by a millimetre).
inline constexpr Metre kPupilToRotationCentre = 9.4_mm;

/// The pupil of an eye turned by `radians` moves aside by kPupilToRotationCentre sin(radians).
Metre pupilShift(double radians);

/// Sideways positions, metres, from a common axis (the straight-ahead line of the eye, or a camera's axis).
struct OffAxis {
    Metre lens;   ///< optical centre of the tunable lens: its decentring delta
    Metre pupil;  ///< centre of the pupil: moved by gaze
    bool operator==(const OffAxis&) const = default;
};

/// x_c = (delta (w + e) - x_pupil w) / e: the point of a surface at `distance` that no power of the lens moves: its
/// chief ray passes the lens's optical centre. Apparent scaling is a homothety about it, exact for a thin lens in the
/// paraxial model (one axis; the other is alike). Precondition: e > 0, distance finite.
Metre scalingCentre(const EyeOptics& eye, Metre distance, const OffAxis& at);

/// x' = x_c + s (x - x_c), s = N(from) / N(to): where on the surface a point `x` is seen through power `to`, in the
/// view through power `from`.
Metre apparentPosition(const EyeOptics& eye, Metre distance, Dioptre from, Dioptre to, const OffAxis& at, Metre x);

/// What an apparent size is measured from.
enum class MagnificationFrom {
    pupil,           ///< an eye that looks straight on: size on its retina
    rotationCentre,  ///< an eye that turns to each point it looks at: by how much it turns (fixation magnification)
    camera,          ///< a camera: size in its picture, by the middle of each blur circle
};

/// From the lens to the point all chief rays pass: e; e + 9.4 mm for the rotation centre; for a camera e, or 0 where
/// the rim of the tunable lens (`lensAperture` across) is the stop at `distance` and `lens`.
Metre viewpointDistance(const EyeOptics& eye, MagnificationFrom from, Metre lensAperture, Metre distance, Dioptre lens);

/// N(from) / N(to) with that distance in place of e. A camera behind a lens that is the stop sees no magnification at
/// all: 1. Precondition: viewpoint times power below 1 for both powers.
double magnificationFrom(const EyeOptics& eye, MagnificationFrom reference, Metre lensAperture, Metre distance,
                         Dioptre from, Dioptre to);

}  // namespace ilf
