// What is not surely known costs power: a distance's uncertainty in the plan.
#include <cmath>

#include "core/document/edit.h"
#include "core/optics/eye.h"
#include "core/perceived/prediction.h"
#include "core/perceived/seam_errors.h"
#include "core/plan/plan.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kSize{64, 48};

/// "Desk" (to be blurred) over the whole picture.
Document deskAt(const Distance& distance, const Box<MeasuredDepth>& measured = {}) {
    Scene scene;
    scene.picture = Box(Picture(kSize, 3, std::vector<std::uint16_t>(64 * 48 * 3, 30000)));
    Document document = newDocument(scene);
    if (measured) document = *edited(document, SetMeasuredDepth{measured});
    Region desk;
    desk.id = "desk";
    desk.name = "Desk";
    desk.look = Look::blur;
    desk.distance = distance;
    document = *edited(document, AddRegion{desk, 0});
    return *edited(document, FillShape{"desk", Rectangle{{0, 0}, {64, 48}}});
}

MeasuredDepth measuredAt(double metres, double sigma) {
    MeasuredDepth measured;
    measured.metres = Image<float>(kSize, 1, std::vector<float>(64 * 48, static_cast<float>(metres)));
    if (sigma > 0.0) measured.sigma = Image<float>(kSize, 1, std::vector<float>(64 * 48, static_cast<float>(sigma)));
    measured.camera = plainPinhole(kSize, 60.0);
    return measured;
}

RegionPlan planned(const Document& document) {
    const auto made = plan(planInput(document));
    REQUIRE_MESSAGE(made.has_value(), (made ? std::string() : made.error().what));
    return made->regions.front();
}

}  // namespace

TEST_CASE("uncertainty: a less certain depth never asks for less power, and P_s is of two deviations nearer") {
    law("any distance, any two uncertainties", [] {
        const double metres = *rc::gen::inRange(40, 200) * 0.01;
        const double less = *rc::gen::inRange(0, 40) * 1e-3, more = less + *rc::gen::inRange(0, 40) * 1e-3;
        const auto pS = [&](double sigma) {
            const Document document = deskAt(FromDepthMap{}, Box(measuredAt(metres, sigma)));
            return plan(planInput(document))->pS->si();
        };
        RC_ASSERT(pS(more) >= pS(less));
        const EyeOptics eye = eyeOptics(Wearer{});
        const double nearest = static_cast<double>(static_cast<float>(metres)) - 0.02 - 2.0 * more;
        if (2.0 * more < 0.4 * metres) {
            RC_ASSERT(std::abs(pS(more) - minimumBlurPower(eye, Metre::fromSi(nearest))->si()) < 1e-4);
        }
    });
}

TEST_CASE("uncertainty: the wearer's own movement counts like the map's") {
    Document document = deskAt(FromDepthMap{}, Box(measuredAt(0.52, 0.0)));
    const RegionPlan still = planned(document);
    CHECK(still.sigma == 0.0_m);
    ViewerPose viewer;
    viewer.sigma = 10.0_mm;
    const RegionPlan moves = planned(*edited(document, SetViewerPose{viewer}));
    CHECK(moves.sigma.si() == doctest::Approx(0.010));
    CHECK(moves.nearest.si() == doctest::Approx(0.48));
    CHECK(*moves.pMin > *still.pMin);
}

TEST_CASE("uncertainty: a slanted region gets the power its nearest point needs, and its blur is a range") {
    PlaneDistance slope{{DistanceAnchor{{0.5, 0.5}, 0.9_m}, {{63.5, 0.5}, 0.9_m}, {{32.0, 47.5}, 0.4_m}}};
    const RegionPlan desk = planned(deskAt(slope));
    CHECK(desk.nearest.si() == doctest::Approx(0.4));
    CHECK(desk.farthest.si() == doctest::Approx(0.9));
    const EyeOptics eye = eyeOptics(Wearer{});
    CHECK(desk.pMin->si() == doctest::Approx(minimumBlurPower(eye, 0.4_m)->si()));
    CHECK(desk.blurDiameter.si() == doctest::Approx(blurDiameter(eye, 0.4_m, desk.levelPower).si()));
    CHECK(desk.blurDiameterFarthest.si() == doctest::Approx(blurDiameter(eye, 0.9_m, desk.levelPower).si()));
    CHECK(desk.blurDiameterFarthest > desk.blurDiameter);
    slope.tolerance = 10.0_mm;
    const RegionPlan unsure = planned(deskAt(slope));
    CHECK(unsure.nearest.si() == doctest::Approx(0.39));
    CHECK(unsure.sigma.si() == doctest::Approx(0.005));
    CHECK(*unsure.pMin > *desk.pMin);
}

TEST_CASE("uncertainty: seams are judged by what the registration left and by how well distances are known") {
    Document document = deskAt(ConstantDistance{1.0_m, 0.0_m});
    auto made = plan(planInput(document));
    REQUIRE(made);
    CHECK(knownErrors(document, *made) == SeamErrors{});  // nothing known: as assumed

    Registration registration = *registered({});
    registration.map = PixelMap(Homography<ProjectorFrame, CameraFrame>{{2, 0, 0, 0, 2, 0, 0, 0, 1}});
    registration.method = Registration::Method::scan;
    registration.rms_px = 0.5;
    document.rig.registration = Box(registration);
    const double onDesk = 0.5 * 0.5 / pixelsPerMetre(document, 1.0_m);  // two projector pixels to one of the picture
    const SeamErrors scanned = knownErrors(document, *made);
    CHECK(scanned.registration.si() == doctest::Approx(onDesk));
    CHECK(scanned.coarseRegistration.si() == doctest::Approx(2.0 * onDesk));
    CHECK(scanned.nearer == SeamErrors{}.nearer);
    // A region's prediction takes the residual at its own distance, or what it is told.
    const RegionPrediction seen = predicted(*made, made->regions.front(), document);
    CHECK(seen.registration == *knownRegistration(document, seen.distance));
    PredictionErrors told;
    told.registration = 2.0_mm;
    CHECK(predicted(*made, made->regions.front(), document, told).registration == 2.0_mm);

    document = *edited(document, SetDistance{"desk", ConstantDistance{1.0_m, 0.3_m}});
    made = plan(planInput(document));
    REQUIRE(made);
    const SeamErrors unsure = knownErrors(document, *made);
    CHECK(unsure.nearer == doctest::Approx(0.3 / 0.7));
    CHECK(unsure.farther == doctest::Approx(0.3 / 0.7));
    // A wider feather follows (scheduling 4.3).
    const auto width = [](const SeamErrors& errors) {
        return hidingWidth(0.0_m, errors.registration, 1.0_mm, 100.0_m).width;
    };
    registration.rms_px = 2.0;
    document.rig.registration = Box(registration);
    CHECK(width(knownErrors(document, *made)) > width(unsure));
}

}  // namespace ilf
