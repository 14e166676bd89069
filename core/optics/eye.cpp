#include "core/optics/eye.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/optics/accommodation.h"
#include "core/optics/forms.h"

namespace ilf {
namespace {

/// An object as a projective point, distance = p / q: infinity is (1 : 0), and no formula needs a case for it.
struct Projective {
    double p, q;
};

Projective projective(Metre distance) {
    return std::isinf(distance.si()) ? Projective{1.0, 0.0} : Projective{distance.si(), 1.0};
}

/// The forms' t and N (w + e - w e P for a finite distance w): N is positive wherever e P < 1. The other forms are not
/// used here: they start from r and P_e, whose 1 - r P_e would cancel where this eye has its ametropia.
struct Passage {
    double p, q, t, n;
};

Passage passage(const EyeOptics& eye, Metre distance, Dioptre lens) {
    using Fast = forms::FastArithmetic<double>;
    const auto [p, q] = projective(distance);
    const double t = forms::vergenceTerm<Fast>(p, q, lens.si());
    return {p, q, t, forms::pupilTerm<Fast>(p, t, eye.lensToPupil.si())};
}

Metre confusionOf(const CircleOfConfusion& confusion, Metre retina) {
    switch (confusion.preset) {
    case CircleOfConfusion::Preset::oneArcmin:
        return retina * kArcmin;
    case CircleOfConfusion::Preset::depthOfField:
        return 20.0_um;
    // b = 1 / (0.65 * pupil in mm): times pupil and retina the pupil cancels (Smith 1991).
    case CircleOfConfusion::Preset::landolt:
        return retina / 650.0;
    case CircleOfConfusion::Preset::typed:
        break;
    }
    return confusion.diameter;
}

}  // namespace

EyeOptics eyeOptics(const Wearer& wearer) {
    EyeOptics eye;
    eye.lensToPupil = wearer.lensToPupil;
    if (wearer.camera) {
        const CameraObserver& camera = *wearer.camera;
        const Dioptre focus = 1.0 / (camera.focusDistance + wearer.lensToPupil);
        eye.pupil = std::min(camera.focalLength / camera.fNumber, wearer.lensAperture);
        eye.retina = 1.0 / (1.0 / camera.focalLength - focus);
        eye.ametropia = -focus;
        eye.confusion = 2.0 * camera.pixelPitch;
        return eye;
    }
    eye.pupil = wearer.pupil;
    eye.retina = 1.0 / wearer.eyePower;
    eye.ametropia = wearer.ametropia;
    eye.accommodation = wearer.measuredAccommodation.value_or(accommodationAtAge(wearer.ageYears));
    eye.confusion = confusionOf(wearer.confusion, eye.retina);
    return eye;
}

Dioptre accommodationAtAge(double years) { return accommodationByAge(years).mean; }

Dioptre acceptableDefocus(const EyeOptics& eye) {
    return Dioptre::fromSi(eye.confusion.si() / (eye.pupil.si() * eye.retina.si()));
}

Carried carriedToLens(const EyeOptics& eye, Dioptre atEye) {
    const double shrink = std::fma(eye.lensToPupil.si(), atEye.si(), 1.0);
    if (shrink <= 0.0) return {{}, false};
    return {atEye / shrink, true};
}

Carried farBorderOffset(const EyeOptics& eye) { return carriedToLens(eye, eye.ametropia + acceptableDefocus(eye)); }

Carried nearBorderOffset(const EyeOptics& eye) {
    return carriedToLens(eye, eye.ametropia - eye.accommodation - acceptableDefocus(eye));
}

Dioptre restPower(const EyeOptics& eye) { return carriedToLens(eye, eye.ametropia).power; }

PowerWindow inFocusWindow(const EyeOptics& eye, Metre distance) {
    const Dioptre infinite = Dioptre::fromSi(std::numeric_limits<double>::infinity());
    const Carried far = farBorderOffset(eye), near = nearBorderOffset(eye);
    if (!far.reachesLens) return {infinite, -infinite};
    const Dioptre vergence = 1.0 / distance;
    return {near.reachesLens ? vergence + near.power : -infinite, vergence + far.power};
}

Result<Dioptre> minimumBlurPower(const EyeOptics& eye, Metre distance) {
    const Carried far = farBorderOffset(eye);
    if (!far.reachesLens) {
        return fail(
            Fault::outOfRange,
            "The wearer's far point lies between lens and eye, so everything is blurred at any power. Check the "
            "prescription and the distance from lens to pupil.");
    }
    return 1.0 / distance + far.power;
}

Dioptre defocus(const EyeOptics& eye, Metre distance, Dioptre lens, Dioptre accommodating) {
    const Passage r = passage(eye, distance, lens);
    return Dioptre::fromSi(-r.t / r.n) - eye.ametropia + accommodating;
}

Metre blurDiameter(const EyeOptics& eye, Metre distance, Dioptre lens) {
    return eye.pupil * (eye.retina * abs(defocus(eye, distance, lens)));
}

Dioptre defocusAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended, Dioptre attendedLens) {
    const Passage r = passage(eye, distance, lens), a = passage(eye, attended, attendedLens);
    // q_a p - q p_a + p p_a (P - P_a): (w - g) + w g (P - P0) for finite distances.
    const double apart = std::fma(a.q, r.p, -(r.q * a.p));
    return Dioptre::fromSi(std::fma(r.p * a.p, (lens - attendedLens).si(), apart) / (r.n * a.n));
}

Metre blurDiameterAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended, Dioptre attendedLens) {
    return eye.pupil * (eye.retina * abs(defocusAttending(eye, distance, lens, attended, attendedLens)));
}

double magnification(const EyeOptics& eye, Metre distance, Dioptre from, Dioptre to) {
    return passage(eye, distance, from).n / passage(eye, distance, to).n;
}

Metre blurRadiusOnSurface(const EyeOptics& eye, Metre distance, Dioptre rest, Dioptre lens) {
    const double angle = eye.pupil * abs(defocusAttending(eye, distance, lens, distance, rest));
    return Metre::fromSi(passage(eye, distance, rest).n * 0.5 * angle);
}

}  // namespace ilf
