#include "core/optics/blurred.h"

#include <limits>

namespace ilf {
namespace {

constexpr Dioptre kUnbounded = Dioptre::fromSi(std::numeric_limits<double>::infinity());

}  // namespace

BlurSide blurredForGood(const EyeOptics& eye, Metre distance, Dioptre lens) {
    const PowerWindow sharp = inFocusWindow(eye, distance);
    if (sharp.low > sharp.high || lens > sharp.high) return BlurSide::far;
    return lens < sharp.low ? BlurSide::near : BlurSide::none;
}

PowerWindow sharpWhileAttending(const EyeOptics& eye, Metre distance, Metre attended, Dioptre attendedLens) {
    // The emmetropic eye's defocus is L'' itself.
    EyeOptics emmetrope = eye;
    emmetrope.ametropia = 0.0_D;
    const Dioptre held = defocus(emmetrope, attended, attendedLens), b = acceptableDefocus(eye);
    const Carried low = carriedToLens(eye, held - b), high = carriedToLens(eye, held + b);
    if (!high.reachesLens) return {kUnbounded, -kUnbounded};
    const Dioptre vergence = 1.0 / distance;
    return {low.reachesLens ? vergence + low.power : -kUnbounded, vergence + high.power};
}

BlurSide blurredWhileAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended,
                               Dioptre attendedLens) {
    const Dioptre off = defocusAttending(eye, distance, lens, attended, attendedLens);
    if (abs(off) <= acceptableDefocus(eye)) return BlurSide::none;
    return off > 0.0_D ? BlurSide::far : BlurSide::near;
}

}  // namespace ilf
