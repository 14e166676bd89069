// Predictions: known values, the laws of their +-, and what the model's parts contribute.
#include "core/perceived/prediction.h"

#include <algorithm>
#include <cmath>

#include "core/compile/compile.h"
#include "core/perceived/seam_profile.h"
#include "core/plan/notes.h"
#include "tests/core/perceived/small_scene.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

PlanObject object(const char* name, double metres, Look look, double tolerance_m = 0.0) {
    return {name, name, look, std::nullopt, Metre::fromSi(metres - tolerance_m), Metre::fromSi(metres + tolerance_m)};
}

/// A document that knows the tolerances of objects, and its plan; a 4 mm pupil, an ideal sine.
struct Planned {
    Document document;
    Plan plan;

    const RegionPlan& region(const char* name) const {
        return *std::ranges::find(plan.regions, RegionId(name), &RegionPlan::id);
    }
    RegionPrediction of(const char* name, const PredictionErrors& errors = {}) const {
        return predicted(plan, region(name), document, errors);
    }
};

Planned planned(std::vector<PlanObject> objects, double ambient_lx = 0.0, Wearer wearer = {}) {
    Planned made;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    made.document.wearer = wearer;
    made.document.rig.waves = WaveMode::idealSine;
    made.document.rig.room.ambient_lx = ambient_lx;
    for (const PlanObject& one : objects) {
        Region region;
        region.id = region.name = one.id;
        region.look = one.look;
        region.distance = ConstantDistance{0.5 * (one.nearest + one.farthest), 0.5 * (one.farthest - one.nearest)};
        made.document.regions.push_back(Box<Region>(region));
    }
    PlanInput input = planInput(made.document);
    input.objects = std::move(objects);
    made.plan = *plan(input);
    return made;
}

Planned desk(double tolerance_m = 0.0, double ambient_lx = 0.0) {
    return planned({object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur, tolerance_m),
                    object("wall", 2.0, Look::neutral)},
                   ambient_lx);
}

constexpr PredictionErrors kNone{0.0_m, 0.0_m, 0.0_m, 0.0_D};

std::vector<Predicted> all(const RegionPrediction& p) {
    return {p.blur_arcmin,    p.defocus_D,     p.snellen,     p.contrast,
            p.contrastLooked, p.snellenLooked, p.ambientLeak, p.seam};
}

}  // namespace

TEST_CASE("prediction: blur is the golden defocus times the pupil, and the plan's own for what is attended") {
    const Planned scene = desk();
    const RegionPrediction clutter = scene.of("clutter");
    const RegionPlan& region = scene.region("clutter");
    // Reference: an object at 500 mm has P_s = 2.0726 D and alpha 0.2: 2.2726 D, seen from 500 mm through 20 mm:
    // E = P / (1 + e (1/w - P)) over 1 + e / w is what an eye held at 0.5 m through 0 D keeps.
    const double e = 0.02, x = 2.0, power = region.levelPower.si();
    CHECK(power == doctest::Approx(2.27261643584172).epsilon(1e-9));
    const double expected = (power - x) / (1.0 - e * (power - x)) + x / (1.0 + e * x);
    CHECK(clutter.defocus_D.value == doctest::Approx(expected).epsilon(1e-12));
    CHECK(clutter.blur_arcmin.value == doctest::Approx(4e-3 * expected * 10800.0 / 3.14159265358979).epsilon(1e-12));
    const EyeOptics& eye = scene.plan.input.eye;
    CHECK(clutter.blur_arcmin.value ==
          doctest::Approx(region.blurDiameterAttending / eye.retina * 10800.0 / 3.14159265358979).epsilon(1e-9));
    CHECK(clutter.contrast.value == doctest::Approx(contrastLeft(scene.plan, region).ambient).epsilon(1e-9));
}

TEST_CASE("prediction: 1 D through 4 mm is like 20/56, and none like 20/20") {
    CHECK(snellenOf(0.0) == 20.0);
    CHECK(snellenOf(4e-3) == doctest::Approx(20.0 * std::hypot(1.0, 2.6)));
    // The circle of confusion that hides a 1 arcmin gap (Smith) costs a factor of the root of 2 here.
    CHECK(snellenOf(1.0 / 650.0) == doctest::Approx(20.0 * std::sqrt(2.0)));
    law("acuity never gets better with blur", [] {
        const double a = *rc::gen::inRange(0, 3000) * 1e-5, b = *rc::gen::inRange(0, 3000) * 1e-5;
        RC_ASSERT(snellenOf(std::min(a, b)) <= snellenOf(std::max(a, b)));
    });
}

TEST_CASE("prediction: real eyes differ from the reduced one as the traced ones do") {
    CHECK(realEyeError(2.0_mm).si() == doctest::Approx(0.021));
    CHECK(realEyeError(4.0_mm).si() == doctest::Approx(0.085));
    CHECK(realEyeError(7.0_mm).si() == doctest::Approx(0.3825));
    CHECK(realEyeError(9.0_mm).si() == doctest::Approx(0.534));
}

TEST_CASE("prediction: what the pupil, a distance and the lens contribute is what the optics say") {
    const Planned scene = desk(0.02);
    const RegionPrediction clutter = scene.of("clutter", {1.0_mm, 0.25_mm, std::nullopt, 0.05_D});
    CHECK(clutter.distance.si() == doctest::Approx(0.5));
    // A quarter more pupil, a quarter more blur; defocus knows no pupil.
    CHECK(clutter.blur_arcmin.part(ErrorSource::pupil) == doctest::Approx(0.25 * clutter.blur_arcmin.value));
    CHECK(clutter.defocus_D.part(ErrorSource::pupil) == 0.0);
    // dE/dw = 1 / N^2 of about 1 / w^2: 4 D a metre, more towards the nearer side.
    const EyeOptics& eye = scene.plan.input.eye;
    const Dioptre lit = scene.region("clutter").levelPower;
    const double nearer = abs(defocus(eye, 0.48_m, lit) - defocus(eye, 0.5_m, lit)).si(),
                 farther = abs(defocus(eye, 0.52_m, lit) - defocus(eye, 0.5_m, lit)).si();
    CHECK(nearer > farther);
    CHECK(clutter.defocus_D.part(ErrorSource::distance) == doctest::Approx(nearer));
    // dE/dP = w^2 / N^2, near 1; the attended level errs by as much: root of 2.
    CHECK(clutter.defocus_D.part(ErrorSource::model) == doctest::Approx(0.05 * std::sqrt(2.0)).epsilon(0.05));
    CHECK(clutter.blur_arcmin.part(ErrorSource::registration) == 0.0);
    CHECK(clutter.seam.part(ErrorSource::registration) > 0.0);
}

TEST_CASE("prediction: without a stated power error it is that of the level and of real eyes") {
    Planned scene = desk();
    const double before = scene.of("book").blur_arcmin.part(ErrorSource::model);
    const double rms = scene.plan.levels[0].rmsError.si(), real = realEyeError(4.0_mm).si();
    CHECK(before == doctest::Approx(4e-3 * std::hypot(rms, real) * 10800.0 / 3.14159265).epsilon(0.1));
    scene.plan.levels[0].rmsError = 3.0 * scene.plan.levels[0].rmsError;
    CHECK(scene.of("book").blur_arcmin.part(ErrorSource::model) > before);
}

TEST_CASE("prediction: contributions add as the root of squares, and shares are of the squares") {
    const Predicted p{10.0, {3.0, 4.0, 0.0, 12.0}};
    CHECK(p.error() == doctest::Approx(13.0));
    CHECK(p.share(ErrorSource::distance) == doctest::Approx(9.0 / 169.0));
    CHECK(p.share(ErrorSource::registration) == 0.0);
    CHECK(Predicted{1.0, {}}.share(ErrorSource::pupil) == 0.0);
    const Planned scene = desk(0.03, 40.0);
    for (const char* name : {"book", "clutter", "wall"}) {
        for (const Predicted& one : all(scene.of(name))) {
            double squares = 0.0, shares = 0.0;
            for (std::size_t i = 0; i < kErrorSources; ++i) {
                squares += one.from[i] * one.from[i];
                shares += one.share(static_cast<ErrorSource>(i));
            }
            CHECK(one.error() == doctest::Approx(std::sqrt(squares)));
            if (one.error() > 0.0) CHECK(shares == doctest::Approx(1.0));
        }
    }
}

TEST_CASE("prediction: without errors there is no +-") {
    const Planned scene = desk(0.03, 40.0);
    for (const char* name : {"book", "clutter", "wall"}) {
        for (const Predicted& one : all(scene.of(name, kNone)))
            CHECK(one.error() == 0.0);
        for (std::size_t i = 0; i < all(scene.of(name)).size(); ++i)
            CHECK(all(scene.of(name, kNone))[i].value == all(scene.of(name))[i].value);
    }
}

TEST_CASE("prediction: more error of any kind never makes blur's +- smaller") {
    const Planned scene = planned({object("book", 0.4, Look::focus), object("clutter", 0.6, Look::blur)});
    law("larger errors, larger +-", [&] {
        const auto in = [](int low, int high, double unit) { return *rc::gen::inRange(low, high) * unit; };
        PredictionErrors a{Metre::fromSi(in(0, 30, 1e-4)), Metre::fromSi(in(0, 50, 1e-5)),
                           Metre::fromSi(in(0, 200, 1e-3)), Dioptre::fromSi(in(0, 60, 0.01))};
        PredictionErrors b = a;
        switch (*rc::gen::inRange(0, 4)) {
        case 0:
            b.pupil += Metre::fromSi(in(1, 10, 1e-4));
            break;
        case 1:
            *b.registration += Metre::fromSi(in(1, 50, 1e-5));
            break;
        case 2:
            *b.distance += Metre::fromSi(in(1, 100, 1e-3));
            break;
        default:
            *b.power += Dioptre::fromSi(in(1, 40, 0.01));
        }
        const RegionPrediction small = scene.of("clutter", a), large = scene.of("clutter", b);
        RC_ASSERT(large.blur_arcmin.error() >= small.blur_arcmin.error() - 1e-9);
        RC_ASSERT(large.defocus_D.error() >= small.defocus_D.error() - 1e-9);
        RC_ASSERT(large.seam.error() >= small.seam.error() - 1e-9);
        // Contrast comes back behind its zeros, and is looked at in points: that may cost a little.
        RC_ASSERT(large.contrast.error() >= small.contrast.error() - 0.01);
    });
}

TEST_CASE("prediction: deeper blur never leaves more contrast than the lobes of a disc's transfer") {
    law("contrast stays under the envelope, and blur grows with strength", [] {
        const double strength = *rc::gen::inRange(2, 60) * 0.1, more = strength + *rc::gen::inRange(1, 20) * 0.1;
        const auto at = [](double dioptres) {
            std::vector<PlanObject> objects{object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)};
            objects[1].strength = Dioptre::fromSi(dioptres);
            return planned(std::move(objects)).of("clutter");
        };
        const RegionPrediction weak = at(strength), strong = at(more);
        RC_ASSERT(strong.blur_arcmin.value > weak.blur_arcmin.value);
        RC_ASSERT(strong.snellen.value > weak.snellen.value);
        // |2 J1(x) / x| <= 2 sqrt(2 / (pi x)) / x beyond the first zero (and a little).
        for (const RegionPrediction& p : {weak, strong}) {
            const double x = 3.14159265 * kReadingDetail_cpd * p.blur_arcmin.value / 60.0;
            if (x > 3.84)
                RC_ASSERT(p.contrast.value <= kPrintContrast * 1.02 * 2.0 * std::sqrt(2.0 / (3.14159265 * x)) / x);
        }
    });
}

TEST_CASE("prediction: a seam has the reference's values") {
    // Scheduling 4.3, 2 D at 0.5 m (R = 2 mm), linear ramps; shift 0.5 mm, then pupils of 3 and 6 mm.
    CHECK(seamOf(8.0_mm, 2.0_mm, 2.0_mm, 0.5_mm) == doctest::Approx(0.063).epsilon(0.02));
    CHECK(seamOf(16.0_mm, 2.0_mm, 2.0_mm, 0.5_mm) == doctest::Approx(0.031).epsilon(0.02));
    CHECK(seamOf(0.0_mm, 2.0_mm, 2.0_mm, 0.5_mm) == doctest::Approx(0.16).epsilon(0.02));
    CHECK(seamOf(24.0_mm, 2.0_mm, 2.0_mm, 2.0_mm) == doctest::Approx(0.083).epsilon(0.02));
    CHECK(seamOf(16.0_mm, 2.0_mm, 1.5_mm, 0.0_mm) == doctest::Approx(0.0066).epsilon(0.08));
    CHECK(seamOf(16.0_mm, 2.0_mm, 3.0_mm, 0.0_mm) == doctest::Approx(0.0133).epsilon(0.02));
    // The paper's ramps in apparent space: 0.212 R / W.
    CHECK(seamOf(10.0_mm, 0.0_mm, 2.0_mm, 0.0_mm) == doctest::Approx(0.0424).epsilon(0.01));
    law("no seam is below the bound of any blending, none above the light itself, and none without a cause", [] {
        const auto mm = [](int low, int high) { return Metre::fromSi(*rc::gen::inRange(low, high) * 1e-4); };
        const Metre width = mm(0, 300), radius = mm(0, 60), shift = mm(0, 40);
        const double seam = seamOf(width, radius, radius, shift);
        RC_ASSERT(seam >= shift / (width + 2.0 * radius + shift + 1e-9_m) - 1e-9);
        RC_ASSERT(seam <= 1.0 + 1e-12);
        RC_ASSERT(seamOf(width, radius, radius, 0.0_m) == 0.0);
    });
}

TEST_CASE("prediction: two lens axes leave a seam, one axis none, and none without a sweep") {
    Wearer oneAxis;
    oneAxis.axes = {LensAxis{}, LensAxis{}};
    const std::vector<PlanObject> objects{object("book", 0.5, Look::focus), object("clutter", 0.5, Look::blur)};
    const Planned two = planned(objects), one = planned(objects, 0.0, oneAxis);
    CHECK(one.of("clutter").seam.value == 0.0);
    const double s = magnification(two.plan.input.eye, 0.5_m, two.plan.focusPower, two.region("clutter").levelPower);
    CHECK(two.of("clutter").seam.value == doctest::Approx((s - 1.0) * 31.5 / 10.0).epsilon(0.02));
    CHECK(two.of("book").seam.value == doctest::Approx(two.of("clutter").seam.value));
    const RegionPrediction still = planned({object("book", 0.5, Look::focus)}).of("book");
    CHECK_FALSE(still.seams);
    CHECK(still.seam.value == 0.0);
}

TEST_CASE("prediction: a seam is as strong as the light an eye receives across a compiled border") {
    // A blurred strip on a wall, 2 px/mm, its border 100 mm right of the middle of both lens axes.
    constexpr Size kWide{800, 300};
    Document d = test::document(
        {test::region("strip", Look::blur, 0.5, test::maskOf(kWide, [](int x, int) { return x < 600; }))}, Look::focus,
        0.5, kWide);
    d.scene.scale.focalPixels = 2000.0 * 0.52;
    d.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    const auto worst = [&](Blending blending) {
        d.seam.blending = blending;
        const auto compiled = compile(d, *plan(planInput(d)));
        REQUIRE(compiled);
        const auto profile = seamProfile(*compiled, {600.0, 150.0}, 10.0);
        REQUIRE(profile);
        return std::pair(std::max(profile->left.worstWeberAfter, profile->right.worstWeberAfter),
                         predicted(compiled->plan, compiled->plan.regions[0], d));
    };
    const auto [blended, strip] = worst(Blending::closedForm);
    CHECK(blended > 0.1);
    CHECK(strip.seam.value == doctest::Approx(blended).epsilon(0.1));
    const auto [hard, hardStrip] = worst(Blending::none);
    CHECK(hardStrip.seam.value >= hard - 0.01);
    CHECK(hardStrip.seam.value <= 1.0);
    CHECK_FALSE(worst(Blending::linearPerceived).second.seams);
}

TEST_CASE("prediction: who looks straight at a blurred region sees it least blurred") {
    const Planned scene = desk();
    const RegionPrediction clutter = scene.of("clutter");
    CHECK(clutter.contrastLooked.value > clutter.contrast.value);
    CHECK(clutter.snellenLooked.value < clutter.snellen.value);
    const EyeOptics& eye = scene.plan.input.eye;
    const double relaxed = eye.pupil * defocus(eye, 0.5_m, scene.region("clutter").levelPower);
    CHECK(clutter.snellenLooked.value == doctest::Approx(snellenOf(relaxed)));
}

TEST_CASE("prediction: neutral light is a mean of what each level's light shows") {
    const Planned scene = desk();
    const RegionPrediction wall = scene.of("wall"), clutter = scene.of("clutter");
    CHECK(wall.sharpShare == doctest::Approx(0.5));
    CHECK(wall.contrast.value > 0.5 * kPrintContrast - 1e-9);
    CHECK(wall.contrast.value < 0.55 * kPrintContrast);
    CHECK(wall.blur_arcmin.value == doctest::Approx(clutter.blur_arcmin.value).epsilon(0.1));
    CHECK(scene.of("book").sharpShare == 1.0);
    CHECK(clutter.sharpShare == 0.0);
}

TEST_CASE("prediction: ambient light takes contrast from what is sharp and gives it to what is blurred") {
    const Planned lit = desk(0.0, 40.0), dark = desk();
    CHECK(lit.of("book").ambientLeak.value < -0.05);
    CHECK(lit.of("clutter").ambientLeak.value > 0.02);
    CHECK(dark.of("clutter").ambientLeak.value == 0.0);
    CHECK(lit.of("clutter").contrast.value ==
          doctest::Approx(contrastLeft(lit.plan, lit.region("clutter")).ambient).epsilon(1e-9));
    law("more ambient light leaks no less", [] {
        const double lux = *rc::gen::inRange(0, 200), more = lux + *rc::gen::inRange(1, 100);
        RC_ASSERT(desk(0.0, more).of("clutter").ambientLeak.value >= desk(0.0, lux).of("clutter").ambientLeak.value);
    });
}

TEST_CASE("prediction: a camera has no pupil to misjudge and no print to read") {
    Wearer camera;
    camera.camera = CameraObserver{};
    const Planned scene = planned({object("B", 0.5, Look::focus), object("C", 0.5, Look::blur)}, 0.0, camera);
    const RegionPrediction c = scene.of("C");
    CHECK(c.camera);
    CHECK(c.blur_arcmin.part(ErrorSource::pupil) == 0.0);
    CHECK(c.print == Legibility::visibleToCamera);
}
