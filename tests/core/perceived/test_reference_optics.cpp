// The reference against golden values and against closed forms written out here: its eye, its lens, its colours.
#include "core/optics/gaze.h"
#include "core/perceived/exposures.h"
#include "tests/core/perceived/reference_cases.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

/// The default eye: 4 mm pupil, 20 mm behind the lens.
constexpr double kPupil = 4e-3, kBehind = 0.02;
constexpr double kMiddleX = 80.0, kMiddleY = 60.0;
constexpr PixelRect<CameraFrame> kInside{40, 30, 120, 90};

/// s = (w + e) / N and the blur on the surface in pixels of the picture, f_px (D_e / 2) E N / (w + e), with
/// N = w + e - w e P and E = w^2 P / (N (w + e)): an eye that holds the surface sharp through 0 D, lens at P.
struct ClosedForm {
    double magnification, radius;
};
ClosedForm closedForm(double w, double power, double focalPixels = 2000.0) {
    const double e = kBehind, n = w + e - w * e * power;
    const double defocus = w * w * power / (n * (w + e));
    return {(w + e) / n, focalPixels * 0.5 * kPupil * defocus * n / (w + e)};
}

std::vector<std::array<double, 3>> modelled(const Radiance& picture, const std::vector<ViewPixel>& pixels,
                                            const std::vector<ClosedForm>& moments) {
    std::vector<std::array<double, 3>> all;
    for (const ViewPixel& pixel : pixels) {
        std::array<double, 3> sum{};
        for (const ClosedForm& m : moments) {
            const double x = kMiddleX + (pixel.x + 0.5 - kMiddleX) / m.magnification;
            const double y = kMiddleY + (pixel.y + 0.5 - kMiddleY) / m.magnification;
            const auto value =
                overDisc([&](double px, double py) { return bilinear(picture, x + m.radius * px, y + m.radius * py); });
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += value[c] / static_cast<double>(moments.size());
        }
        all.push_back(sum);
    }
    return all;
}

SeenPoint pointSeen(const Played& scene, const ViewRequest& request, int atX, int atY, double magnification) {
    const auto pixels = pixelsIn({atX - 15, atY - 15, atX + 17, atY + 17});
    return seenPoint(rays(scene, request, pixels, 4096), pixels, magnification);
}

}  // namespace

TEST_CASE("reference: a hundredth more in magnification or in a radius is told from the right closed form") {
    const Played scene = through(lookingAt(texture(kSmall, 7), 0.5, 0.5), 2.0);
    const Radiance picture = plainView(scene.document, 1.0);
    const auto pixels = somePixels(kInside, 400);
    const ReferencePixels seen = rays(scene, lookingHere(), pixels, 8192);
    const ClosedForm right = closedForm(0.5, 2.0);
    const auto with = [&](double s, double r) {
        return agreement(seen, modelled(picture, pixels, {{right.magnification * s, right.radius * r}}));
    };
    const double same = with(1.0, 1.0), larger = with(1.01, 1.0), smaller = with(0.99, 1.0), wider = with(1.0, 1.01),
                 narrower = with(1.0, 0.99);
    MESSAGE("closed form ", same, " dB; s +-1 %: ", larger, ", ", smaller, "; radius +-1 %: ", wider, ", ", narrower,
            "; noise floor ", seen.noiseFloor_dB);
    CHECK(same > 72.0);
    CHECK(larger < 50.0);
    CHECK(smaller < 50.0);
    CHECK(wider < 66.0);
    CHECK(narrower < 66.0);
}

TEST_CASE("reference: a point is as large and as far out as the golden tables say, and as bright") {
    // beta_acc_arcmin and scale_s of eye_blur_circle_Dr.csv: an eye accommodated to the object through 0 D.
    struct Golden {
        double metres, power, beta_arcmin, scale;
    };
    for (const Golden& golden :
         {Golden{0.25, 1.0, 12.011693818256252, 1.0188679245283019},
          Golden{0.5, 1.0, 12.962846043683783, 1.0196078431372549}, Golden{0.5, 2.0, 26.444205929114917, 1.04},
          Golden{1.0, 1.0, 13.481359885431134, 1.02}}) {
        const Played scene = through(lookingAt(point(120, 90), golden.metres, golden.metres), golden.power);
        const SeenPoint seen = pointSeen(scene, lookingHere(), 120, 90, golden.scale);
        const double radius = 2000.0 * 0.5 * golden.beta_arcmin * std::numbers::pi / 10800.0;
        CHECK((seen.x - kMiddleX) / (120.5 - kMiddleX) == doctest::Approx(golden.scale).epsilon(2e-4));
        CHECK((seen.y - kMiddleY) / (90.5 - kMiddleY) == doctest::Approx(golden.scale).epsilon(2e-4));
        CHECK(seen.radius == doctest::Approx(radius).epsilon(4e-3));
        // Radiance is conserved, so a larger image holds more light.
        CHECK(seen.light == doctest::Approx(golden.scale * golden.scale).epsilon(4e-3));
    }
}

TEST_CASE("reference: each eye magnifies about its own lens axis") {
    for (const Eye eye : {Eye::left, Eye::right}) {
        Document d = lookingAt(point(80, 60), 0.5, 0.5);
        d.wearer = Wearer{};
        const SeenPoint seen = pointSeen(through(d, 2.0), lookingHere(eye), 80, 60, 1.04);
        const double centre = kMiddleX + (eye == Eye::left ? -0.0315 : 0.0315) * 2000.0 / 0.52;
        CHECK(seen.x - 80.5 == doctest::Approx(0.04 * (80.5 - centre)).epsilon(5e-3));
    }
}

TEST_CASE("reference: an evenly lit surface is as bright as in steady light") {
    const Played scene = through(lookingAt(white(), 0.5, 0.5), 2.0);
    for (const auto& seen : rays(scene, lookingHere(), somePixels(kInside, 20), 64).radiance) {
        for (const double value : seen)
            CHECK(value == doctest::Approx(1.0).epsilon(1e-12));
    }
}

TEST_CASE("reference: a myope's lens rests at the prescription, and what is looked at is sharp there") {
    // F0 = -3 D: P_off = F0 / (1 + e F0).
    const double rest = -3.0 / (1.0 - 3.0 * kBehind);
    Document d = lookingAt(point(120, 90), 0.5, 0.5);
    d.wearer.ametropia = -3.0_D;
    Played scene = through(d, rest);
    scene.plan.focusPower = Dioptre::fromSi(rest);
    for (RegionPlan& one : scene.plan.regions)
        one.levelPower = Dioptre::fromSi(rest);
    const SeenPoint still = pointSeen(scene, lookingHere(), 120, 90, 1.0);
    CHECK(still.radius < 0.05);
    CHECK(still.x == doctest::Approx(120.5).epsilon(1e-5));
    // Past its range it sees as far as it can: a presbyope of 1 D attending 0.5 m is 1/0.52 - 1 D short.
    Document old = lookingAt(point(120, 90), 0.5, 0.5);
    old.wearer.measuredAccommodation = 1.0_D;
    const SeenPoint blurred = pointSeen(through(old, 0.0), lookingHere(), 120, 90, 1.0);
    CHECK(blurred.radius == doctest::Approx(2000.0 * 0.5 * kPupil * (1.0 / 0.52 - 1.0)).epsilon(4e-3));
}

TEST_CASE("reference: a camera keeps its own focus and pupil") {
    Document d = lookingAt(point(100, 75), 0.5, 0.5);
    d.wearer.camera = CameraObserver{};
    d.wearer.camera->focusDistance = 0.5_m;
    d.scene.scale.focalPixels = 250.0;
    const Played scene = through(d, 1.0);
    const SeenPoint seen = pointSeen(scene, {}, 100, 75, 1.0196078431372549);
    // D_r and d_er of camera_blur_Dr.csv (500 mm, 1 D, 20 mm, "obj"), for 16 mm of its 24 / 1.4 mm.
    const double beta = 406.61425860666847e-6 / 25.161290322580645e-3 * 16.0 / (24.0 / 1.4);
    CHECK(seen.radius == doctest::Approx(250.0 * 0.5 * beta).epsilon(4e-3));
    CHECK((seen.x - kMiddleX) / (100.5 - kMiddleX) == doctest::Approx(1.0196078431372549).epsilon(1e-3));
}

TEST_CASE("reference: a slot mid-sweep is integrated over the lens's own way") {
    // One slot of 1 ms while a 60 Hz sine runs upwards through the middle of 0 to 2.5 D: 1.01 to 1.49 D.
    Played scene = through(lookingAt(texture(kSmall, 7), 0.5, 0.5), 0.0);
    scene.plan.waveform = idealSine(0.0_D, 0.0_D, 2.5_D, 60.0_Hz, 0.0_s);
    for (Slot& slot : scene.plan.slots)
        slot.lit.clear();
    const auto count = static_cast<double>(scene.plan.slots.size());
    Slot& lit = scene.plan.slots[3];
    lit.start = Second::fromSi(0.25 / 60.0 - 0.5e-3);
    lit.duration = 1.0_ms;
    lit.lit = {{0, count * scene.plan.light}};
    const auto powerAt = [](double part) {
        return 1.25 - 1.25 * std::cos(2.0 * std::numbers::pi * (0.25 + 60.0 * (part - 0.5) * 1e-3));
    };
    std::vector<ClosedForm> during;
    for (int i = 0; i < 16; ++i)
        during.push_back(closedForm(0.5, powerAt((i + 0.5) / 16.0)));
    const Radiance picture = plainView(scene.document, 1.0);
    const auto pixels = somePixels(kInside, 100);
    const ReferencePixels seen = rays(scene, lookingHere(), pixels, 8192);
    const double all = agreement(seen, modelled(picture, pixels, during));
    const double middle = agreement(seen, modelled(picture, pixels, {closedForm(0.5, 1.25)}));
    MESSAGE("integrated ", all, " dB, one moment ", middle, " dB, noise floor ", seen.noiseFloor_dB);
    CHECK(all > 68.0);
    CHECK(middle < 60.0);
}

TEST_CASE("reference: a planned sweep is what each slot's light and power give, added up") {
    const double metres = 0.5, f = 800.0;
    Document d = document({region("left", Look::focus, metres, maskIn({0, 0, 70, 120}))}, Look::blur, metres);
    d.scene.scale.focalPixels = f;
    const Played scene = played(d);
    REQUIRE(scene.plan.focusPower == 0.0_D);
    const Radiance plain = plainView(d, 1.0);
    const auto pixels = somePixels({20, 20, 140, 100}, 60);
    const double centre = kMiddleX - 0.0315 * f / (metres + kBehind);
    std::vector<std::array<double, 3>> model(pixels.size());
    for (const view::Exposure& exposure : view::exposures(scene.plan)) {
        const LightImage& light = scene.program.images[static_cast<std::size_t>(exposure.level)];
        std::vector<float> lit(plain.pixels().begin(), plain.pixels().end());
        for (std::size_t i = 0; i < lit.size(); ++i) {
            const int pixel = static_cast<int>(i / 3);
            lit[i] *= static_cast<float>(light.at(pixel % kSmall.width, pixel / kSmall.width)) / 255.0F;
        }
        const Radiance image(kSmall, 3, std::move(lit));
        constexpr int kMoments = 6;
        for (int moment = 0; moment < kMoments; ++moment) {
            const Second t = exposure.start + ((moment + 0.5) / kMoments) * exposure.duration;
            const ClosedForm form = closedForm(metres, scene.plan.waveform.powerAt(t).si(), f);
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const double x = centre + (pixels[i].x + 0.5 - centre) / form.magnification;
                const double y = kMiddleY + (pixels[i].y + 0.5 - kMiddleY) / form.magnification;
                const auto seen = overDisc(
                    [&](double px, double py) { return bilinear(image, x + form.radius * px, y + form.radius * py); });
                for (std::size_t c = 0; c < 3; ++c)
                    model[i][c] += exposure.weight / kMoments * seen[c];
            }
        }
    }
    const ReferencePixels seen = rays(scene, {}, pixels, 8192);
    const double dB = agreement(seen, model);
    MESSAGE("planned sweep: ", dB, " dB, noise floor ", seen.noiseFloor_dB);
    CHECK(dB > 74.0);
}

TEST_CASE("reference: the room's light falls on everything during the whole sweep") {
    Played scene = through(lookingAt(texture(kSmall, 7), 0.5, 0.5), 2.0);
    // Projector and room each give half; the projector shows nothing.
    scene.plan.input.rig.room.ambient_lx = 330.0 / 0.5 * scene.plan.light;
    const auto pixels = somePixels(kInside, 100);
    const auto both = rays(scene, lookingHere(), pixels, 1024);
    for (auto& image : scene.program.images)
        image = TileGrid(scene.program.projector);
    const auto room = rays(scene, lookingHere(), pixels, 1024);
    double worst = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        worst = std::max(worst, std::abs(room.radiance[i][0] - 0.5 * both.radiance[i][0]));
    CHECK(worst < 5e-3);
}

TEST_CASE("reference: blue, green and red light are blurred by the eye's refraction in each") {
    Played scene = through(lookingAt(point(100, 75), 0.5, 0.5), 0.0);
    scene.plan.input.rig.primaries = std::array<Metre, 3>{625e-9_m, 525e-9_m, 460e-9_m};
    ViewRequest request = lookingHere();
    request.chromatic = true;
    // Thibos et al. 1992, as optics.md 1.4 has it to two digits: +0.19, -0.31, -0.85 D.
    const std::array<double, 3> refraction{0.19, 0.31, 0.85};
    const auto around = pixelsIn({88, 63, 114, 89});
    const ReferencePixels together = rays(scene, request, around);
    for (std::size_t c = 0; c < 3; ++c) {
        const SeenPoint seen = seenPoint(together, around, 1.0, c);
        CHECK(seen.radius == doctest::Approx(2000.0 * 0.5 * kPupil * refraction[c]).epsilon(0.03));
        CHECK(seen.x == doctest::Approx(100.5).epsilon(1e-4));
    }
    request.chromatic = false;
    CHECK(pointSeen(scene, request, 100, 75, 1.0).radius < 0.05);
    scene.plan.input.rig.primaries = std::array<Metre, 3>{625e-9_m, 525e-9_m, 200e-9_m};
    request.chromatic = true;
    CHECK_FALSE(Reference::of(scene.document, scene.plan, scene.program, request));
}

TEST_CASE("reference: what lies beyond the lens's rim is seen past it, sharp and in steady light") {
    // 100 px of slope: the 8 mm rim, 20 mm before the pupil, is a circle of 40 px.
    Document d = lookingAt(texture(kSmall, 7), 0.5, 0.5);
    d.scene.scale.focalPixels = 100.0;
    const Played scene = through(d, 2.0);
    const Radiance plain = plainView(d, 1.0);
    ViewRequest request = lookingHere();
    request.lensField = true;
    const auto row = pixelsIn({80, 60, 150, 61});
    const auto within = rays(scene, lookingHere(), row, 256), seen = rays(scene, request, row, 256);
    for (std::size_t i = 0; i < row.size(); ++i) {
        // The pupil's 2 mm blurs the rim by 10 px.
        const double out = row[i].x + 0.5 - kMiddleX;
        if (out > 29.0 && out < 51.0) continue;
        const double expected = out < 29.0 ? within.radiance[i][1] : static_cast<double>(plain.at(row[i].x, 60, 1));
        CHECK(seen.radiance[i][1] == doctest::Approx(expected).epsilon(1e-9));
    }
    // With nothing lit, what is left is what goes past: half of the pupil where the rim crosses its middle, and a bit
    // more, for the rim is round: the pupil's bundle is 2 / (1 + e / w) = 1.923 mm about it at the lens.
    Played dark = scene;
    for (auto& image : dark.program.images)
        image = TileGrid(dark.program.projector);
    const double share =
        rays(dark, request, {{119, 59}}, 16384).radiance[0][1] / static_cast<double>(plain.at(119, 59, 1));
    const double height = 1e-3 * 20.0 * std::hypot(0.395, 0.005), bundle = 1e-3 * 2.0 / 1.04;
    double past = 0.0;
    constexpr int kCells = 800;
    for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
            const double x = 2.0 * (i + 0.5) / kCells - 1.0, y = 2.0 * (j + 0.5) / kCells - 1.0;
            if (x * x + y * y < 1.0 && std::hypot(height + bundle * x, bundle * y) > 8e-3)
                past += 4.0 / (kCells * kCells) / std::numbers::pi;
        }
    }
    CHECK(share == doctest::Approx(past).epsilon(0.01));
}

TEST_CASE("reference: an eye that turns magnifies about another point, or as seen from its centre of rotation") {
    const Played scene = through(lookingAt(point(120, 90), 0.5, 0.5), 2.0);
    ViewRequest follows = lookingHere();
    follows.gaze = Gaze::follows;
    const double behind = kBehind + kPupilToRotationCentre.si();
    const double fixation = (0.5 + behind) / (0.5 + behind - 0.5 * behind * 2.0);
    const SeenPoint turned = pointSeen(scene, follows, 120, 90, fixation);
    CHECK((turned.x - kMiddleX) / (120.5 - kMiddleX) == doctest::Approx(fixation).epsilon(5e-4));
    CHECK(turned.radius == doctest::Approx(closedForm(0.5, 2.0).radius * fixation).epsilon(4e-3));

    // Turned to the right edge: the pupil is aside by 9.4 mm times the sine, and x_c = -(w / e) x_pupil.
    ViewRequest fixed = lookingHere();
    fixed.gaze = Gaze::fixed;
    fixed.gazeAt = {159.5, 60.0};
    const double slope = (159.5 - kMiddleX) / 2000.0 * 0.52 / (0.5 + behind);
    const double aside = kPupilToRotationCentre.si() * std::sin(std::atan(slope));
    const double centre = kMiddleX - 0.5 / kBehind * aside * 2000.0 / 0.52;
    const SeenPoint gazing = pointSeen(scene, fixed, 120, 90, 1.04);
    CHECK(gazing.x == doctest::Approx(centre + 1.04 * (120.5 - centre)).epsilon(2e-4));
    CHECK(gazing.y == doctest::Approx(kMiddleY + 1.04 * (90.5 - kMiddleY)).epsilon(2e-4));
    // Through the lens at rest a turned eye sees the picture where it was.
    CHECK(pointSeen(through(scene.document, 0.0), fixed, 120, 90, 1.0).x == doctest::Approx(120.5).epsilon(1e-6));
    fixed.gazeAt = {-1.0, 0.0};
    CHECK_FALSE(Reference::of(scene.document, scene.plan, scene.program, fixed));
}
