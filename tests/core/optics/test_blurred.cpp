// Both meanings of "blurred", for powers of either sign.
#include "core/optics/blurred.h"

#include <cmath>

#include "tests/support/law.h"

using namespace ilf;

namespace {

EyeOptics someEye() {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::depthOfField;
    wearer.measuredAccommodation = Dioptre::fromSi(0.1 * *rc::gen::inRange(0, 120));
    wearer.ametropia = Dioptre::fromSi(0.1 * *rc::gen::inRange(-60, 40));
    return eyeOptics(wearer);
}

EyeOptics referenceEye(Dioptre accommodation) {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    wearer.measuredAccommodation = accommodation;
    return eyeOptics(wearer);
}

Metre distance() { return Metre::fromSi(1e-3 * *rc::gen::inRange(100, 5000)); }
Dioptre power() { return Dioptre::fromSi(0.01 * *rc::gen::inRange(-1500, 1000)); }

}  // namespace

TEST_CASE("blurred for good: negative powers only beyond the near border") {
    const EyeOptics young = referenceEye(10.0_D), old = referenceEye(0.5_D);
    CHECK(blurredForGood(young, 0.5_m, -10.0_D) == BlurSide::none);  // 1/w + K_n = -10.61 D
    CHECK(blurredForGood(young, 0.5_m, -10.62_D) == BlurSide::near);
    CHECK(blurredForGood(young, 0.5_m, 2.07_D) == BlurSide::none);
    CHECK(blurredForGood(young, 0.5_m, 2.08_D) == BlurSide::far);
    CHECK(blurredForGood(old, 0.5_m, 1.4_D) == BlurSide::near);
    CHECK(blurredForGood(old, 0.5_m, 1.45_D) == BlurSide::none);
    EyeOptics behind = young;
    behind.ametropia = -60.0_D;
    CHECK(blurredForGood(behind, 0.5_m, 0.0_D) == BlurSide::far);
}

TEST_CASE("blurred for good: no accommodation in the eye's range brings it below the acceptable blur") {
    law("the verdict is that of the best of 200 accommodations", [] {
        const EyeOptics eye = someEye();
        const Metre w = distance();
        const Dioptre p = power();
        double best = HUGE_VAL, side = 0.0;
        for (int i = 0; i <= 200; ++i) {
            const double off = defocus(eye, w, p, (i / 200.0) * eye.accommodation).si();
            if (std::abs(off) < best) {
                best = std::abs(off);
                side = off;
            }
        }
        const double b = acceptableDefocus(eye).si();
        RC_PRE(std::abs(best - b) > 0.05);  // the search's own step
        const BlurSide expected = best <= b ? BlurSide::none : side > 0.0 ? BlurSide::far : BlurSide::near;
        RC_ASSERT(blurredForGood(eye, w, p) == expected);
    });
}

TEST_CASE("blurred while attending: positive and negative powers alike") {
    const EyeOptics eye = referenceEye(10.0_D);
    CHECK(blurredWhileAttending(eye, 0.5_m, 1.0_D, 0.5_m, 0.0_D) == BlurSide::far);
    CHECK(blurredWhileAttending(eye, 0.5_m, -1.0_D, 0.5_m, 0.0_D) == BlurSide::near);
    CHECK(blurredWhileAttending(eye, 0.5_m, 0.01_D, 0.5_m, 0.0_D) == BlurSide::none);
    law("inside the window of sharp powers it is sharp, outside on the window's side blurred", [] {
        const EyeOptics any = someEye();
        const Metre w = distance(), attended = distance();
        const Dioptre p = power(), p0 = power();
        const PowerWindow sharp = sharpWhileAttending(any, w, attended, p0);
        RC_PRE(abs(p - sharp.low) > 1e-9_D && abs(p - sharp.high) > 1e-9_D);
        const BlurSide expected = p > sharp.high ? BlurSide::far : p < sharp.low ? BlurSide::near : BlurSide::none;
        RC_ASSERT(blurredWhileAttending(any, w, p, attended, p0) == expected);
    });
    law("what is attended is sharp", [] {
        const EyeOptics any = someEye();
        const Metre w = distance();
        const Dioptre p = power();
        const PowerWindow sharp = sharpWhileAttending(any, w, w, p);
        RC_ASSERT(sharp.low <= p && p <= sharp.high);
    });
}
