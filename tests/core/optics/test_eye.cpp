// Borders, blur and magnification against values worked out with 50 digits, and the laws between them.
#include "core/optics/eye.h"

#include <cmath>
#include <limits>

#include "tests/support/law.h"

using namespace ilf;

namespace {

/// The reduced eye the reference values are for: 60 D, A = 10 D, 4 mm pupil, 20 mm from the lens, 1 arcmin.
Wearer referenceWearer() {
    Wearer wearer;
    wearer.measuredAccommodation = 10.0_D;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    return wearer;
}

EyeOptics referenceEye() { return eyeOptics(referenceWearer()); }

bool near(double value, double expected, double relative) {
    return std::abs(value - expected) <= relative * std::abs(expected);
}

double millimetres(int from, int to) { return 1e-3 * *rc::gen::inRange(from, to); }
Dioptre power(int fromCentidioptre, int toCentidioptre) {
    return Dioptre::fromSi(0.01 * *rc::gen::inRange(fromCentidioptre, toCentidioptre));
}

}  // namespace

TEST_CASE("eye: the least power that blurs is 1/d + K_f, to twelve digits") {
    const EyeOptics eye = referenceEye();
    CHECK(near(acceptableDefocus(eye).si(), 0.07272205216643040, 1e-13));
    CHECK(near(farBorderOffset(eye).power.si(), 0.07261643584172196, 1e-13));
    CHECK(near(nearBorderOffset(eye).power.si(), -12.61383516467965, 1e-13));
    CHECK(std::abs(minimumBlurPower(eye, 0.5_m)->si() - 2.07261643584172) < 1e-12);
    CHECK(std::abs(minimumBlurPower(eye, 0.25_m)->si() - 4.07261643584172) < 1e-12);
    CHECK(std::abs(minimumBlurPower(eye, 1.3_m)->si() - 0.841847205072491) < 1e-12);
}

TEST_CASE("eye: the far border is the relaxed eye's, so the paper's +- labels are put right") {
    const EyeOptics eye = referenceEye();
    // Read literally, the labels give 1.92717 D: two acceptable defocuses too little.
    CHECK(minimumBlurPower(eye, 0.5_m)->si() > 2.0);
    CHECK(near(inFocusWindow(eye, 0.4_m).high.si(), 2.572616435841722, 1e-13));
}

TEST_CASE("eye: a prescription shifts the far border by more than its offset") {
    const double expected[][3] = {{-6.0, -6.818181818181818, -4.724429161441152},
                                  {-2.0, -2.083333333333333, -0.004544225457184705},
                                  {4.0, 3.703703703703704, 5.765967291453617}};
    for (const auto& [ametropia, offset, pMin] : expected) {
        Wearer wearer = referenceWearer();
        wearer.ametropia = Dioptre::fromSi(ametropia);
        const EyeOptics eye = eyeOptics(wearer);
        CHECK(std::abs(restPower(eye).si() - offset) < 1e-14 * std::abs(offset) + 1e-15);
        CHECK(std::abs(minimumBlurPower(eye, 0.5_m)->si() - pMin) < 1e-12);
    }
}

TEST_CASE("eye: age narrows the window of sharp powers from its low end") {
    Wearer wearer = referenceWearer();
    wearer.measuredAccommodation.reset();
    wearer.ageYears = 30.0;
    CHECK(near(inFocusWindow(eyeOptics(wearer), 0.4_m).low.si(), -9.339434335053242, 1e-12));
    wearer.ageYears = 70.0;
    CHECK(eyeOptics(wearer).accommodation == 0.0_D);
    CHECK(near(inFocusWindow(eyeOptics(wearer), 0.4_m).low.si(), 2.427172023835934, 1e-12));
}

TEST_CASE("eye: blur circles of the relaxed and of the attending eye") {
    const EyeOptics eye = referenceEye();
    CHECK(near(blurDiameter(eye, 0.25_m, 3.0_D).in(1.0_um), 65.359477124183007, 1e-12));
    CHECK(near(blurDiameter(eye, 0.5_m, 1.0_D).in(1.0_um), 65.359477124183007, 1e-12));
    CHECK(blurDiameter(eye, 0.5_m, 2.0_D) == 0.0_m);
    CHECK(near(blurDiameterAttending(eye, 0.5_m, 1.0_D, 0.5_m, 0.0_D).in(1.0_um), 62.845651080945199, 1e-12));
    CHECK(near(blurDiameterAttending(eye, 1.0_m, 2.0_D, 1.0_m, 0.0_D).in(1.0_um), 133.38668800853675, 1e-12));
}

TEST_CASE("eye: presets of the circle of confusion") {
    Wearer wearer = referenceWearer();
    CHECK(near(eyeOptics(wearer).confusion.si(), 4.848136811095360e-6, 1e-13));
    wearer.confusion.preset = CircleOfConfusion::Preset::depthOfField;
    CHECK(std::abs(minimumBlurPower(eyeOptics(wearer), 0.5_m)->si() - 2.29821073558648) < 1e-12);
    wearer.confusion.preset = CircleOfConfusion::Preset::landolt;
    CHECK(std::abs(minimumBlurPower(eyeOptics(wearer), 0.5_m)->si() - 2.38167938931298) < 1e-12);
    const Metre landolt = eyeOptics(wearer).confusion;
    wearer.pupil = 6.0_mm;
    CHECK(eyeOptics(wearer).confusion == landolt);
    wearer.confusion = {CircleOfConfusion::Preset::typed, 10.0_um};
    CHECK(eyeOptics(wearer).confusion == 10.0_um);
}

TEST_CASE("eye: a camera is a thin lens at its focus, its pupil limited by the tunable lens") {
    Wearer wearer;
    wearer.camera = CameraObserver{};
    const EyeOptics eye = eyeOptics(wearer);
    CHECK(near(eye.retina.si(), 25.161290322580645e-3, 1e-12));
    CHECK(eye.pupil == 16.0_mm);
    CHECK(blurDiameter(eye, 0.5_m, 0.0_D).si() < 1e-17);
    CHECK(restPower(eye).si() == doctest::Approx(-2.0));
    wearer.lensAperture = 40.0_mm;
    CHECK(near(blurDiameter(eyeOptics(wearer), 0.5_m, 2.0_D).in(1.0_um), 829.49308755760369, 1e-12));
}

TEST_CASE("eye: magnification about the optical centre") {
    const EyeOptics eye = referenceEye();
    CHECK(near(magnification(eye, 0.5_m, 0.0_D, 1.0_D), 1.019607843137255, 1e-15));
    CHECK(near(magnification(eye, 0.5_m, 0.0_D, 2.0_D), 1.04, 1e-15));
    CHECK(near(magnification(eye, 0.25_m, 0.0_D, 3.0_D), 1.058823529411765, 1e-15));
    CHECK(magnification(eye, 0.5_m, 1.5_D, 1.5_D) == 1.0);
}

TEST_CASE("eye: a far point between lens and eye is said in words, a near point there leaves the window open") {
    Wearer wearer = referenceWearer();
    wearer.ametropia = -60.0_D;
    CHECK(minimumBlurPower(eyeOptics(wearer), 0.5_m).error().what.find("far point") != std::string::npos);
    const PowerWindow closed = inFocusWindow(eyeOptics(wearer), 0.5_m);
    CHECK(closed.low > closed.high);
    wearer = referenceWearer();
    wearer.measuredAccommodation = 55.0_D;
    CHECK(std::isinf(inFocusWindow(eyeOptics(wearer), 0.5_m).low.si()));
}

TEST_CASE("eye: infinity is a distance like any other") {
    const EyeOptics eye = referenceEye();
    const Metre infinity = Metre::fromSi(std::numeric_limits<double>::infinity());
    CHECK(defocus(eye, infinity, 0.0_D) == 0.0_D);
    CHECK(minimumBlurPower(eye, infinity)->si() == farBorderOffset(eye).power.si());
    CHECK(magnification(eye, infinity, 0.0_D, 2.0_D) == doctest::Approx(1.0 / 0.96));
    CHECK(defocusAttending(eye, infinity, 1.0_D, infinity, 1.0_D) == 0.0_D);
}

TEST_CASE("eye: laws of blur") {
    law("exactly at the least power that blurs, the blur circle is the acceptable one", [] {
        Wearer wearer = referenceWearer();
        wearer.ametropia = power(-400, 300);
        wearer.pupil = Metre::fromSi(millimetres(2, 8));
        const EyeOptics eye = eyeOptics(wearer);
        const Metre distance = Metre::fromSi(millimetres(120, 5000));
        const Metre blur = blurDiameter(eye, distance, *minimumBlurPower(eye, distance));
        RC_ASSERT(std::abs(blur / eye.confusion - 1.0) < 1e-9);
    });
    law("the attending eye's defocus is the difference of two relaxed ones", [] {
        const EyeOptics eye = referenceEye();
        const Metre object = Metre::fromSi(millimetres(120, 5000)), attended = Metre::fromSi(millimetres(120, 5000));
        const Dioptre lens = power(-500, 900), attendedLens = power(-500, 900);
        const Dioptre direct = defocus(eye, object, lens) - defocus(eye, attended, attendedLens);
        const Dioptre exact = defocusAttending(eye, object, lens, attended, attendedLens);
        RC_ASSERT(abs(direct - exact) < 1e-11_D);
    });
    law("the blur radius across a surface is (D_e/2) d^2 P / N", [] {
        const EyeOptics eye = referenceEye();
        const double d = millimetres(120, 5000);
        const Dioptre lens = power(0, 900);
        const double n = d + 0.02 - d * 0.02 * lens.si();
        const double expected = 0.002 * d * d * lens.si() / n;
        RC_ASSERT(std::abs(blurRadiusOnSurface(eye, Metre::fromSi(d), 0.0_D, lens).si() - expected) < 1e-15);
    });
    law("magnifications multiply", [] {
        const EyeOptics eye = referenceEye();
        const Metre distance = Metre::fromSi(millimetres(120, 5000));
        const Dioptre a = power(-500, 900), b = power(-500, 900), c = power(-500, 900);
        const double product = magnification(eye, distance, a, b) * magnification(eye, distance, b, c);
        RC_ASSERT(std::abs(product / magnification(eye, distance, a, c) - 1.0) < 1e-14);
    });
}

TEST_CASE("blur on the surface: is measured against the view through the lens at rest, prescription included") {
    Wearer wearer;
    wearer.ametropia = -4.0_D;
    const EyeOptics eye = eyeOptics(wearer);
    const Dioptre rest = restPower(eye), lens = rest + 2.0_D;
    const double angle = eye.pupil * abs(defocusAttending(eye, 0.5_m, lens, 0.5_m, rest));
    // N(rest) = w + e - w e P: 0.5 + 0.02 + 0.01 * 4.3478 = 0.563478 m, 8 % more than through 0 D.
    CHECK(blurRadiusOnSurface(eye, 0.5_m, rest, lens).si() == doctest::Approx(0.5634782608695652 * 0.5 * angle));
}
