// Decentred lens, turned eye, camera and aperture stop against rays traced through the matrices.
#include "core/optics/gaze.h"

#include <cmath>

#include "core/optics/aperture.h"
#include "core/optics/ray_matrix.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

/// A thin lens whose centre lies at `centre`: deflects by -P (height - centre).
Ray deflected(Ray ray, double power, double centre) {
    const Ray about = thinLens(power) * Ray{ray.height - centre, ray.slope};
    return {about.height + centre, about.slope};
}

Ray traced(double x, double slope, double distance, double power, double lens, double e) {
    return travel(e) * deflected(travel(distance) * Ray{x, slope}, power, lens);
}

/// The chief ray of the point x: of the affine family of its rays the one that meets the pupil's centre.
Ray chiefRay(double x, double distance, double power, double lens, double e, double pupil) {
    const double h0 = traced(x, 0.0, distance, power, lens, e).height;
    const double perSlope = traced(x, 1.0, distance, power, lens, e).height - h0;
    return traced(x, (pupil - h0) / perSlope, distance, power, lens, e);
}

/// Where a lens of no power would have to show the point for the eye to get the same chief ray.
double seenAt(double x, double distance, double power, double lens, double e, double pupil) {
    const Ray chief = chiefRay(x, distance, power, lens, e, pupil);
    return pupil - chief.slope * (distance + e);
}

EyeOptics eyeAt(double e) {
    Wearer wearer;
    wearer.lensToPupil = Metre::fromSi(e);
    return eyeOptics(wearer);
}

double metres(int from_um, int to_um) { return 1e-6 * *rc::gen::inRange(from_um, to_um); }

}  // namespace

TEST_CASE("gaze: apparent scaling is a homothety about x_c, as traced") {
    law("a decentred lens and a moved pupil, together", [] {
        const double e = metres(10000, 40000), w = metres(150000, 3000000), lens = metres(-5000, 5000);
        const double pupil = metres(-5000, 5000), x = metres(-100000, 100000);
        const double from = 0.01 * *rc::gen::inRange(-500, 800), to = 0.01 * *rc::gen::inRange(-500, 800);
        const EyeOptics eye = eyeAt(e);
        const OffAxis at{Metre::fromSi(lens), Metre::fromSi(pupil)};
        // The view through `from` is turned into a place on the surface, and so is the view through `to`: both scale
        // the surface about x_c, so their ratio does.
        const double centre = scalingCentre(eye, Metre::fromSi(w), at).si();
        const double before = seenAt(x, w, from, lens, e, pupil), after = seenAt(x, w, to, lens, e, pupil);
        const double expected = apparentPosition(eye, Metre::fromSi(w), Dioptre::fromSi(from), Dioptre::fromSi(to), at,
                                                 Metre::fromSi(before))
                                    .si();
        RC_ASSERT(std::abs(after - expected) < 1e-10);
        RC_ASSERT(std::abs(seenAt(centre, w, to, lens, e, pupil) - centre) < 1e-10);
    });
}

TEST_CASE("gaze: known values") {
    const EyeOptics eye = eyeAt(0.020);
    CHECK(scalingCentre(eye, 0.5_m, {1.0_mm, 0.0_m}).in(1.0_mm) == doctest::Approx(26.0));   // delta (w + e) / e
    CHECK(scalingCentre(eye, 0.5_m, {0.0_m, 1.0_mm}).in(1.0_mm) == doctest::Approx(-25.0));  // -x_pupil w / e
    CHECK(scalingCentre(eye, 0.5_m, {}) == 0.0_m);
    // 10 degrees at 2 D moves the whole seam by about 1.7 mm at 0.5 m.
    const Metre centre = scalingCentre(eye, 0.5_m, {0.0_m, pupilShift(10.0 * 3.14159265358979 / 180.0)});
    CHECK(abs(0.04 * centre).in(1.0_mm) == doctest::Approx(1.63).epsilon(0.01));
}

TEST_CASE("gaze: magnification from pupil, rotation centre and camera") {
    const EyeOptics eye = eyeAt(0.020);
    const auto from = [&](MagnificationFrom what) {
        return magnificationFrom(eye, what, 16.0_mm, 0.5_m, 0.0_D, 2.0_D);
    };
    CHECK(from(MagnificationFrom::pupil) == magnification(eye, 0.5_m, 0.0_D, 2.0_D));
    CHECK(from(MagnificationFrom::rotationCentre) == doctest::Approx(0.5294 / 0.5));
    CHECK(from(MagnificationFrom::camera) == from(MagnificationFrom::pupil));  // a small pupil stops the beam itself
    law("the eye that turns to a point turns by the angle of the ray through its rotation centre", [] {
        const double e = metres(10000, 30000), w = metres(150000, 3000000), x = metres(1000, 50000);
        const double power = 0.01 * *rc::gen::inRange(-500, 800), toCentre = e + kPupilToRotationCentre.si();
        const double turned = chiefRay(x, w, power, 0.0, toCentre, 0.0).slope;
        const double still = chiefRay(x, w, 0.0, 0.0, toCentre, 0.0).slope;
        const double s = magnificationFrom(eyeAt(e), MagnificationFrom::rotationCentre, 16.0_mm, Metre::fromSi(w),
                                           0.0_D, Dioptre::fromSi(power));
        RC_ASSERT(std::abs(turned / still / s - 1.0) < 1e-11);
    });
}

TEST_CASE("aperture: the beam that passes both rims, as traced") {
    law("the pupil's lit part is D_eff wide", [] {
        const double w = metres(150000, 3000000), e = metres(10000, 40000), rim = metres(5000, 20000);
        EyeOptics eye = eyeAt(e);
        eye.pupil = Metre::fromSi(metres(2000, 20000));
        const double power = 0.01 * *rc::gen::inRange(-500, 800);
        // The ray from the axis to the lens's edge lands at the pupil where D_eff ends, unless the pupil is smaller.
        const Ray atLens = travel(w) * Ray{0.0, 0.5 * rim / w};
        const double lands = (travel(e) * thinLens(power) * atLens).height;
        const double expected = std::min(eye.pupil.si(), 2.0 * lands);
        const Metre distance = Metre::fromSi(w), lens = Metre::fromSi(rim);
        const Dioptre p = Dioptre::fromSi(power);
        RC_ASSERT(std::abs(effectivePupil(eye, lens, distance, p).si() - expected) < 1e-13);
        RC_ASSERT(lensIsStop(eye, lens, distance, p) == (2.0 * lands < eye.pupil.si()) ||
                  std::abs(2.0 * lands - eye.pupil.si()) < 1e-12);
    });
}

TEST_CASE("aperture: the paper's camera is stopped by the tunable lens, and its blur is linear in P") {
    Wearer wearer;
    wearer.camera = CameraObserver{};
    wearer.lensAperture = 40.0_mm;
    const EyeOptics camera = eyeOptics(wearer);  // its own pupil: 24 mm / 1.4 = 17.1 mm
    const double expected_px[] = {23.0415, 46.0829, 69.1244};
    for (int i = 1; i <= 3; ++i) {
        const Dioptre p = Dioptre::fromSi(i);
        CHECK(lensIsStop(camera, 16.0_mm, 0.5_m, p));
        CHECK(0.5 * blurDiameterStopped(camera, 16.0_mm, 0.5_m, p).in(8.4_um) ==
              doctest::Approx(expected_px[i - 1]).epsilon(1e-5));
    }
    CHECK(magnificationFrom(camera, MagnificationFrom::camera, 16.0_mm, 0.5_m, 0.0_D, 2.0_D) == 1.0);
    CHECK_FALSE(lensIsStop(eyeAt(0.02), 16.0_mm, 0.5_m, 5.0_D));
    CHECK(effectivePupil(eyeAt(0.02), 16.0_mm, Metre::fromSi(HUGE_VAL), 2.0_D) == eyeAt(0.02).pupil);
}
