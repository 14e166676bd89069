// The closed forms against the matrices they come from: two ways to the same ray.
#include "core/optics/ray_matrix.h"

#include <cmath>

#include "core/optics/kernel.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

OpticsCase someCase() {
    OpticsCase in;
    in.setDistance(1e-3 * *rc::gen::inRange(100, 5000));
    in.power = 0.01 * *rc::gen::inRange(-1000, 1000);
    in.lensToPupil = 1e-3 * *rc::gen::inRange(0, 40);
    in.retina = 1.0 / 60.0;
    in.eyePower = 60.0 + 0.1 * *rc::gen::inRange(-60, 100);
    in.pupil = 1e-3 * *rc::gen::inRange(2, 8);
    in.confusion = 5e-6;
    in.height = 1e-3 * *rc::gen::inRange(1, 100);
    return in;
}

bool near(double a, double b, double scale) { return std::abs(a - b) <= 1e-11 * scale; }

}  // namespace

TEST_CASE("matrices: every system of travel and lenses has determinant one") {
    const RayMatrix system = objectToRetina(0.5, 2.0, 0.02, 61.0, 1.0 / 60.0);
    CHECK(near(system.determinant(), 1.0, 1.0));
}

TEST_CASE("matrices: N is the pupil height of a ray of slope one, and s compares two powers") {
    law("the closed form and the matrices agree", [] {
        const OpticsCase in = someCase();
        const auto got = evaluate(in, OpticsPath::precise);
        const double n = (objectToPupil(in.p, in.power, in.lensToPupil) * Ray{0.0, 1.0}).height;
        const double n0 = (objectToPupil(in.p, 0.0, in.lensToPupil) * Ray{0.0, 1.0}).height;
        RC_ASSERT(near(got[Optic::N], n, 10.0));
        RC_ASSERT(near(got[Optic::s], n0 / n, 10.0));
    });
}

TEST_CASE("matrices: the ray through the pupil's edge lands D_r / 2 off the axis") {
    law("the closed form and the matrices agree", [] {
        const OpticsCase in = someCase();
        const double n = (objectToPupil(in.p, in.power, in.lensToPupil) * Ray{0.0, 1.0}).height;
        const Ray edge{0.0, 0.5 * in.pupil / n};
        const Ray landed = objectToRetina(in.p, in.power, in.lensToPupil, in.eyePower, in.retina) * edge;
        const auto got = evaluate(in, OpticsPath::precise);
        RC_ASSERT(near(got[Optic::Dr], 2.0 * std::abs(landed.height), 0.01));
        // In front of the retina (myopic, E > 0) the ray has crossed the axis.
        RC_ASSERT(near(got[Optic::E] * in.pupil * in.retina, -2.0 * landed.height, 0.01));
    });
}

TEST_CASE("matrices: the lens's own image of the object lies at d_Ei, at the height x_2") {
    law("the closed form and the matrices agree", [] {
        const OpticsCase in = someCase();
        RC_PRE(std::abs(1.0 - in.p * in.power) > 0.05);
        const RayMatrix lens = thinLens(in.power) * travel(in.p);
        const auto got = evaluate(in, OpticsPath::precise);
        RC_ASSERT(near(got[Optic::dEi], imageDistance(lens), 100.0));
        // The paper takes x_2 along the object's side: the erect virtual image has a negative distance and size.
        RC_ASSERT(near(got[Optic::x2], -imageScale(lens) * in.height, 10.0));
    });
}

TEST_CASE("matrices: an object on the far border blurs by exactly the acceptable circle") {
    law("the closed form and the matrices agree", [] {
        OpticsCase in = someCase();
        in.eyePower = 60.0;
        const auto got = evaluate(in, OpticsPath::precise);
        RC_PRE(std::abs(got[Optic::pMinFar] * in.lensToPupil) < 0.9);
        in.power = got[Optic::pMinFar];
        const auto onBorder = evaluate(in, OpticsPath::precise);
        RC_ASSERT(near(onBorder[Optic::Dr], in.confusion, in.pupil));
        RC_ASSERT(onBorder[Optic::E] > 0.0);
        RC_ASSERT(near(onBorder[Optic::wFar], in.p, 10.0 * in.p));
    });
}
