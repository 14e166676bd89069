// Seams along whole borders, against the tables of the reference (scheduling 4.1 and 4.3), and what is said of them.
#include "core/perceived/seam_border.h"

#include <algorithm>
#include <cmath>

#include "core/perceived/seam_profile.h"
#include "core/perceived/seam_weighting.h"
#include "tests/core/perceived/seam_scene.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

BorderSeam only(const Compiled& compiled, const SeamQuestion& question = {}) {
    const auto seams = borderSeams(compiled, question);
    REQUIRE(seams.size() == 1);
    return seams.front();
}

double under(const BorderSeam& seam, const std::string& what) {
    for (const SeamUnderError& error : seam.errors) {
        if (error.what.find(what) != std::string::npos) return error.eyes[0].weber;
    }
    FAIL("no error " << what);
    return 0.0;
}

}  // namespace

TEST_CASE("border seams: the four blendings leave what the reference's table says") {
    // Scheduling 4.1: power, radius, none, linear in object space, linear in perceived space.
    struct Row {
        double power_D, radius_mm, none, object, perceived;
    };
    for (const Row& row : {Row{1, 50, 1.00, 0.78, 0.21}, Row{1, 150, 1.00, 0.93, 0.071}, Row{2, 50, 1.00, 0.80, 0.21},
                           Row{2, 100, 1.00, 0.90, 0.106}, Row{2, 150, 1.00, 0.93, 0.071}}) {
        for (const bool inside : {true, false}) {
            CAPTURE(row.power_D);
            CAPTURE(row.radius_mm);
            CAPTURE(inside);
            SeamQuestion question;
            question.underErrors = false;
            const BorderSeam seam =
                only(seamCompiled({row.power_D, row.radius_mm, 10.0, inside, Blending::closedForm}), question);
            const auto left = [&](Blending b) { return seam.blendings[static_cast<std::size_t>(b)][0].weber; };
            // Pixels of a quarter of a millimetre round off what is as narrow as the table's seams at 50 mm.
            CHECK(left(Blending::none) == doctest::Approx(row.none).epsilon(row.radius_mm < 75 ? 0.16 : 0.01));
            CHECK(left(Blending::linearObject) == doctest::Approx(row.object).epsilon(0.1));
            CHECK(left(Blending::linearPerceived) == doctest::Approx(row.perceived).epsilon(0.26));
            CHECK(left(Blending::closedForm) < 0.003);
            CHECK(seam.blendings[0][0].gap == !inside);
        }
    }
}

TEST_CASE("border seams: errors leave what the reference's table says") {
    // Scheduling 4.3, closed form, 2 D at 100 mm, in percent.
    struct Row {
        double feather_mm, shift025, shift05, pupil3, pupil5, lens;
    };
    for (const Row& row :
         {Row{8, 3.1, 6.3, 1.3, 1.3, 5.0}, Row{16, 1.6, 3.1, 0.7, 0.7, 2.6}, Row{24, 1.0, 2.1, 0.4, 0.4, 1.8}}) {
        CAPTURE(row.feather_mm);
        const BorderSeam seam = only(seamCompiled({2.0, 100.0, row.feather_mm}));
        // 8 bits of light and pixels leave up to this much of it by themselves.
        const double own = seam.now[0].weber;
        CHECK(own < 0.0025);
        const auto percent = [&](double value) { return doctest::Approx(value / 100.0 + own / 2).epsilon(0.1); };
        CHECK(under(seam, "registration 0.25") == percent(row.shift025));
        CHECK(under(seam, "registration 0.50") == percent(row.shift05));
        CHECK(under(seam, "pupil") == percent(row.pupil3));
        CHECK(under(seam, "lens to pupil") == percent(row.lens));
        // 5 mm off: 4 % at W = 5 mm, so 20 / W; ten degrees: 17 % at W = 10 mm for a pupil 10 mm before the centre of
        // rotation, ours lies 9.4 mm before it.
        CHECK(under(seam, "optical centre 5") == percent(20.0 / row.feather_mm));
        CHECK(under(seam, "10 degrees") == percent(0.94 * 170.0 / row.feather_mm));
        // A camera does not refocus: to the table's 0.1 to 0.6 comes its own blur of 0.18 D.
        CHECK(under(seam, "nearer") < 0.0135);
        // The laws.
        CHECK(under(seam, "registration 0.50") ==
              percent(100.0 * contrastOfShift(0.5_mm, Metre::fromSi(1e-3 * row.feather_mm))));
        CHECK(under(seam, "registration 0.50") >
              leastContrastOfShift(0.5_mm, Metre::fromSi(1e-3 * row.feather_mm), seam.hiding.blurRadius));
        CHECK(under(seam, "pupil") == percent(100.0 * contrastOfBlur(0.5_mm, Metre::fromSi(1e-3 * row.feather_mm))));
        for (const SeamUnderError& error : seam.errors) {
            CHECK(error.eyes[0].weber >= own);
            CHECK(error.eyes[0].weighted < error.eyes[0].weber);
        }
        // Root of the squares of what the counted ones add.
        double squares = 0.0;
        for (const SeamUnderError& error : seam.errors)
            squares += error.counts ? std::pow(error.eyes[0].weber - own, 2) : 0.0;
        CHECK(seam.combined[0] == doctest::Approx(own + std::sqrt(squares)));
    }
}

TEST_CASE(
    "border seams: two lens axes 63 mm apart put a seam in two places, and the width that would hide it says so") {
    SeamQuestion question;
    const Compiled compiled = seamCompiled({2.0, 60.0, 10.0, true, Blending::closedForm, 63.0});
    const BorderSeam seam = only(compiled, question);
    const double s = magnification(compiled.plan.input.eye, 0.5_m, 0.0_D, 2.0_D);
    CHECK(seam.apart.in(1.0_mm) == doctest::Approx((s - 1.0) * 63.0).epsilon(1e-3));
    CHECK(seam.hiding.axesShift.in(1.0_mm) == doctest::Approx((s - 1.0) * 31.5).epsilon(1e-3));
    // The blend lies in the middle, so each eye is left with half of it over the feather.
    for (const SeamContrast& eye : seam.now)
        CHECK(eye.weber == doctest::Approx(contrastOfShift(seam.hiding.axesShift, 10.0_mm)).epsilon(0.06));
    CHECK(seam.now[0].gap != seam.now[1].gap);
    CHECK(seam.hiding.asked.in(1.0_mm) > 100.0);
    CHECK(seam.hiding.clamped);
    CHECK(seam.says.find("apart") != std::string::npos);
    CHECK(seam.says.find("more than the region has room for") != std::string::npos);
}

TEST_CASE("border seams: the width that hides a seam is within its limits, and hides what it says") {
    law("W = clamp(shift / 1 % - 2 R, 2 R, region / 3)", [] {
        const auto metres = [](int low, int high) { return Metre::fromSi(1e-6 * *rc::gen::inRange(low, high)); };
        const Metre axes = metres(0, 2000), errors = metres(0, 1000), radius = metres(1, 5000),
                    extent = metres(1000, 300000);
        const HidingWidth hiding = hidingWidth(axes, errors, radius, extent);
        RC_ASSERT(hiding.width >= 2.0 * radius);
        RC_ASSERT(hiding.width <= std::max(extent / 3.0, 2.0 * radius));
        RC_ASSERT(hiding.clamped == (hiding.asked > hiding.width));
        if (!hiding.clamped) RC_ASSERT(leastContrastOfShift(axes + errors, hiding.width, radius) <= 0.01 + 1e-12);
    });
    // A single eye, no errors but the registration: what is asked hides it.
    SeamQuestion question;
    question.errors.gaze = question.errors.lensToPupil = 0.0_mm;
    SeamScene scene;
    scene.height = 320;
    const BorderSeam narrow = only(seamCompiled(scene), question);
    CHECK_FALSE(narrow.hiding.clamped);
    CHECK(under(narrow, "registration 0.25") > 0.02);
    scene.feather_mm = narrow.hiding.width.in(1.0_mm);
    const BorderSeam wide = only(seamCompiled(scene), question);
    CHECK(under(wide, "registration 0.25") < 0.015);
}

TEST_CASE("border seams: agree with the profile at the cursor, which is worked out on a patch of its own") {
    for (const Blending blending : {Blending::none, Blending::linearPerceived}) {
        const Compiled compiled = seamCompiled({2.0, 100.0, 10.0, true, blending, 20.0});
        SeamQuestion question;
        question.underErrors = question.allBlendings = false;
        const BorderSeam seam = only(compiled, question);
        const auto profile = seamProfile(compiled, seam.now[0].at, 5.0);
        REQUIRE(profile);
        CHECK(seam.now[0].weber == doctest::Approx(profile->left.worstWeberAfter).epsilon(0.06));
        CHECK(seam.now[1].weber == doctest::Approx(profile->right.worstWeberAfter).epsilon(0.06));
        CHECK(seam.points.size() == static_cast<std::size_t>(seam.profiles));
    }
}

TEST_CASE("border seams: neutral regions beside focused ones have a seam too; without a sweep there is none") {
    Document d = seamDocument({});
    Region background = *d.background;
    background.look = Look::neutral;
    d.background = Box<Region>(background);
    d.regions.push_back(
        Box<Region>(region("sharp", Look::focus, 0.5, maskOf(d.scene.size(), [](int x, int) { return x > 480; }))));
    const auto seams = borderSeams(*compile(d, *plan(planInput(d))));
    REQUIRE(seams.size() == 2);
    const bool both = std::ranges::any_of(
        seams, [](const BorderSeam& s) { return s.blurred == kBackgroundId && s.other == "sharp"; });
    CHECK(both);
    d.regions.erase(d.regions.begin());
    CHECK(borderSeams(*compile(d, *plan(planInput(d)))).empty());
}

TEST_CASE("border seams: long borders are thinned out and say so, and a cancelled search gives nothing") {
    const Compiled compiled = seamCompiled({});
    SeamQuestion question;
    question.underErrors = question.allBlendings = false;
    const BorderSeam whole = only(compiled, question);
    CHECK(whole.sampled == 1.0);
    CHECK(whole.length.in(1.0_mm) == doctest::Approx(24.0 * 0.785).epsilon(0.01));
    question.mostPatches = 1;
    const BorderSeam thinned = only(compiled, question);
    CHECK(thinned.sampled < 1.0);
    CHECK(thinned.profiles < whole.profiles);
    CHECK(borderSeams(compiled, question, [] { return true; }).empty());
}

TEST_CASE("border seams: contrast sensitivity peaks at 8 cycles per degree and passes little of slow changes") {
    CHECK(contrastSensitivity(7.9) == doctest::Approx(1.0));
    for (const double f : {0.5, 2.0, 5.0, 12.0, 30.0})
        CHECK(contrastSensitivity(f) < 1.0);
    // A grating (that fades at both ends) keeps its contrast at the peak; one at half a cycle per degree keeps a fifth.
    constexpr double kStep = 0.02;
    constexpr int kCount = 600;
    const auto grating = [&](double f) {
        std::vector<double> wave;
        for (int i = 0; i < kCount; ++i)
            wave.push_back(std::cos(6.283185307 * f * kStep * (i - kCount / 2)) *
                           (0.5 - 0.5 * std::cos(6.283185307 * i / kCount)));
        return SeamWeighting(kStep, kCount).worst(wave);
    };
    CHECK(grating(8.0) == doctest::Approx(1.0).epsilon(0.05));
    CHECK(grating(0.5) == doctest::Approx(contrastSensitivity(0.5)).epsilon(0.3));
}
