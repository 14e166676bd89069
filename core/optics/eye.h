// The optics of one eye (or camera) behind one tunable lens: blur, borders, magnification.
#pragma once

#include <numbers>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/document/wearer.h"

namespace ilf {

/// A minute of arc, radians.
inline constexpr double kArcmin = std::numbers::pi / 10800.0;

/// A reduced eye behind a thin tunable lens. Symbols of the paper (Ueda et al. 2020, section 3) in brackets.
/// The eye is held as (retina, ametropia, accommodation) and never as r and P_e apart: 1 - r P_e would cancel.
struct EyeOptics {
    Metre pupil;            ///< entrance pupil diameter [D_e]
    Metre lensToPupil;      ///< [d_Ee]
    Metre retina;           ///< pupil to retina, reduced [d_er]
    Dioptre ametropia;      ///< F0 = 1/d_er - P_e^f: 0 for an emmetrope, negative for a myope
    Dioptre accommodation;  ///< amplitude A = P_e^n - P_e^f
    Metre confusion;        ///< acceptable circle of confusion on the retina [D_r^a]
    bool operator==(const EyeOptics&) const = default;
};

/// The wearer's eye, or the camera that stands in for it: a thin lens focused at its distance, its pupil limited by the
/// tunable lens, which has nothing to accommodate with.
EyeOptics eyeOptics(const Wearer& wearer);

/// Hofstetter's mean amplitude of accommodation, 18.5 - 0.3 age, at least 0 D (valid to about 60 years).
Dioptre accommodationAtAge(double years);

/// b = D_r^a / (D_e d_er): the defocus that is just acceptable.
Dioptre acceptableDefocus(const EyeOptics& eye);

/// K(y) = y / (1 + d_Ee y): a vergence error at the eye, carried to the lens. `reachesLens` is false when
/// 1 + d_Ee y <= 0 (the far point lies between lens and eye): then there is no such border.
struct Carried {
    Dioptre power;
    bool reachesLens = true;
};
Carried carriedToLens(const EyeOptics& eye, Dioptre atEye);

/// K_f and K_n: both borders are 1/d_oE = P - K (closed form of the paper's eq. for d^a, with its +- labels put right:
/// the far border belongs to the relaxed eye).
Carried farBorderOffset(const EyeOptics& eye);
Carried nearBorderOffset(const EyeOptics& eye);

/// P_off = K(F0): the lens power that corrects the wearer. The lens rests there; 0 D for an emmetrope. Not asked of a
/// camera, whose focus is its own: there the lens rests at 0 D (Plan::waveform.rest holds the right one of the two).
Dioptre restPower(const EyeOptics& eye);

/// Powers for which an object at `distance` is seen sharp: [1/d + K_n, 1/d + K_f].
struct PowerWindow {
    Dioptre low, high;
    bool operator==(const PowerWindow&) const = default;
};
/// Open below (-infinity) when the near point lies between lens and eye; empty (low > high) when the far point does.
PowerWindow inFocusWindow(const EyeOptics& eye, Metre distance);

/// P_min = 1/d_oE + K_f: strictly above it the object is blurred whatever the eye does. Error when the eye's far point
/// lies between lens and eye (everything is blurred already).
Result<Dioptre> minimumBlurPower(const EyeOptics& eye, Metre distance);

/// Signed defocus at the eye in dioptres, positive = image in front of the retina (myopic side), of an object at
/// `distance` seen through power `lens`:  E = L'' - F0 + accommodating,  L'' = V / (1 - e V), V = P - 1/d.
/// `accommodating` 0 D is the relaxed eye. Precondition: d_Ee * P < 1.
Dioptre defocus(const EyeOptics& eye, Metre distance, Dioptre lens, Dioptre accommodating = {});

/// Blur-circle diameter on the retina, D_r = D_e d_er |E|, relaxed eye: the least that can be reached.
Metre blurDiameter(const EyeOptics& eye, Metre distance, Dioptre lens);

/// The same for an eye that holds an object at `attended` sharp through power `attendedLens`: uses the exact difference
/// L''(d, P) - L''(g, P0) = (d g (P - P0) + (d - g)) / (N N0), which does not cancel. Signed, in dioptres.
Dioptre defocusAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended, Dioptre attendedLens);
Metre blurDiameterAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended, Dioptre attendedLens);

/// Apparent magnification about the optical centre when the lens goes from power `from` to `to`:
/// s = N(from) / N(to), N(P) = d + e - d e P; with from = 0 this is the paper's s.
double magnification(const EyeOptics& eye, Metre distance, Dioptre from, Dioptre to);

/// Apparent blur radius against the view through `rest`, measured across the surface in metres at `distance`, for an
/// eye focused on that surface through `rest`: a point at x_1 is seen at the angle x_1 / N(rest), so R = N(rest) (D_e /
/// 2) |E| with E of `defocusAttending` at the same distance. Through a lens at 0 D, times pixelsPerMetre, it is f_px
/// D_r / (2 d_er).
Metre blurRadiusOnSurface(const EyeOptics& eye, Metre distance, Dioptre rest, Dioptre lens);

}  // namespace ilf
