#include <cmath>
#include <numbers>
#include <random>

#include "core/document/edit.h"
#include "core/document/history.h"
#include "core/document/viewer_place.h"
#include "core/document/wearer_distances.h"
#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kSize{40, 24};

MeasuredDepth measuredAt(float metres, float sigma = 0.0F) {
    MeasuredDepth measured;
    const std::size_t pixels = std::size_t{40} * 24;
    measured.metres = Image<float>(kSize, 1, std::vector<float>(pixels, metres));
    if (sigma > 0.0F) measured.sigma = Image<float>(kSize, 1, std::vector<float>(pixels, sigma));
    measured.camera = plainPinhole(kSize, 35.0);
    measured.source = "test";
    return measured;
}

/// Turned about the vertical axis: the viewer looks `degrees` to the right of the camera.
ViewerPose turned(double degrees, std::array<double, 3> place = {}) {
    const double a = degrees * std::numbers::pi / 180.0;
    Pose<CameraSpace, ViewerSpace> viewer;
    viewer.rotation = {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
    viewer.translation = place;
    ViewerPose pose;
    pose.viewerFromCamera = viewer.inverted();
    return pose;
}

ViewerPose behind(double metres) {
    ViewerPose pose;
    pose.viewerFromCamera.translation = {0, 0, metres};
    return pose;
}

Document withDepth(float metres, float sigma = 0.0F) {
    Document document = newDocument(sceneOf(kSize));
    document = *edited(document, AddRegion{regionOf("b", "Hands", Look::blur, 0.5_m), 0});
    document = *edited(document, SetMeasuredDepth{Box(measuredAt(metres, sigma))});
    return *edited(document, SetDistance{"b", FromDepthMap{}});
}

}  // namespace

TEST_CASE("wearer's distances: at the camera they are the camera's depth less lens to pupil") {
    law("any depth, any lens", [] {
        Wearer wearer;
        wearer.lensToPupil = Metre::fromSi(*rc::gen::inRange(0, 60) * 1e-3);
        const auto depth = static_cast<float>(*rc::gen::inRange(100, 90000) * 1e-3);
        const DepthMap map = wearerDistances(measuredAt(depth), {}, wearer);
        const double expected = static_cast<double>(depth) - wearer.lensToPupil.si();
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{39, 23}, std::pair{20, 7}})
            RC_ASSERT(std::abs(static_cast<double>(map.metres.at(x, y)) - expected) < 1e-7 * expected);
        RC_ASSERT(map.sigma.empty());
    });
}

TEST_CASE("wearer's distances: moving the wearer back by x adds x everywhere") {
    law("any way back", [] {
        const double x = *rc::gen::inRange(0, 3000) * 1e-3;
        const DepthMap at = wearerDistances(measuredAt(0.8F), {}, {}),
                       away = wearerDistances(measuredAt(0.8F), behind(x), {});
        RC_ASSERT(std::abs(static_cast<double>(away.metres.at(3, 4) - at.metres.at(3, 4)) - x) < 1e-6);
    });
}

TEST_CASE("wearer's distances: a turned wearer measures along their own axis, from where they are") {
    law("any turn, any place, a lens that distorts", [] {
        MeasuredDepth measured = measuredAt(1.5F);
        measured.camera.distortion = {-0.1, 0.02, 0.001, -0.001, 0.0};
        const ViewerPose viewer = turned(*rc::gen::inRange(-400, 400) * 0.1,
                                         {*rc::gen::inRange(-5, 5) * 0.1, 0.2, *rc::gen::inRange(-10, 3) * 0.1});
        const DepthMap map = wearerDistances(measured, viewer, {});
        for (int y = 0; y < kSize.height; y += 5) {
            for (int x = 0; x < kSize.width; x += 3) {
                const auto [sx, sy] = measured.camera.slopesOf(x + 0.5, y + 0.5);
                const double d = viewer.viewerFromCamera({sx * 1.5, sy * 1.5, 1.5}).z - 0.02;
                const double seen = static_cast<double>(map.metres.at(x, y));
                // Slopes are a line between every eighth pixel: here, with 40 px across, far coarser than in a picture.
                const bool right = d < 0.01 ? seen < 0.02 : std::abs(seen - d) < 8e-3;
                RC_ASSERT(right);
            }
        }
    });
}

TEST_CASE("viewer's place: what is typed is where they are, and comes back") {
    CHECK(viewerAt({}) == ViewerPose{});
    law("any place, any direction", [] {
        const auto number = [](int most) { return *rc::gen::inRange(-most, most + 1) * 0.01; };
        const ViewerPlace place{Metre::fromSi(number(200)), Metre::fromSi(number(200)), Metre::fromSi(number(200)),
                                100.0 * number(80), 100.0 * number(80)};
        const ViewerPlace back = placeOf(viewerAt(place));
        RC_ASSERT(std::abs((back.right - place.right).si()) < 1e-9);
        RC_ASSERT(std::abs((back.down - place.down).si()) < 1e-9);
        RC_ASSERT(std::abs((back.behind - place.behind).si()) < 1e-9);
        RC_ASSERT(std::abs(back.turned_deg - place.turned_deg) < 1e-6);
        RC_ASSERT(std::abs(back.tilted_deg - place.tilted_deg) < 1e-6);
    });
    // Half a metre behind the camera and turned to the right, a point on the line of sight is straight ahead.
    const ViewerPose viewer = viewerAt({0.0_m, 0.0_m, 0.5_m, 90.0, 0.0});
    const auto ahead = viewer.viewerFromCamera({2.0, 0.0, -0.5});
    CHECK(std::abs(ahead.x) < 1e-9);
    CHECK(ahead.z == doctest::Approx(2.0));
    CHECK(viewerAt({0.0_m, 0.0_m, 0.0_m, 0.0, 45.0}).viewerFromCamera({0.0, 1.0, 1.0}).z ==
          doctest::Approx(std::sqrt(2.0)));
}

TEST_CASE("wearer's distances: what is behind the lens, too near, too far or not measured is a hole") {
    CHECK(wearerDistances(measuredAt(0.5F), behind(-0.6), {}).metres.at(1, 1) == 0.0F);
    CHECK(wearerDistances(measuredAt(0.025F), {}, {}).metres.at(1, 1) == 0.0F);
    CHECK(wearerDistances(measuredAt(0.035F), {}, {}).metres.at(1, 1) == doctest::Approx(0.015));
    CHECK(wearerDistances(measuredAt(1001.0F), {}, {}).metres.at(1, 1) == 0.0F);
    CHECK(wearerDistances(measuredAt(0.0F), behind(5.0), {}).metres.at(1, 1) == 0.0F);
}

TEST_CASE("wearer's distances: uncertainties of depth and of the wearer's place add in squares") {
    ViewerPose viewer;
    viewer.sigma = 4.0_mm;
    CHECK(wearerDistances(measuredAt(1.0F, 0.003F), viewer, {}).sigma.at(2, 2) == doctest::Approx(0.005));
    CHECK(wearerDistances(measuredAt(1.0F), viewer, {}).sigma.at(2, 2) == doctest::Approx(0.004));
    // Looking askew, less of the camera's own error lies along the wearer's axis.
    const DepthMap askew = wearerDistances(measuredAt(1.0F, 0.003F), turned(60.0, {-2.0, 0, 0}), {});
    CHECK(askew.sigma.at(20, 12) == doctest::Approx(0.0015).epsilon(0.05));
}

TEST_CASE("measured depth: distances follow the wearer's pose and lens, and undo brings all back") {
    History history(withDepth(1.0F));
    const auto step = [&](const Edit& edit) {
        auto next = edited(history.current(), edit);
        REQUIRE_MESSAGE(next.has_value(), (next ? std::string() : next.error().what));
        history.preview(*std::move(next));
        history.commit(label(edit));
    };
    const auto metres = [&] { return static_cast<double>(history.current().scene.depth->metres.at(5, 5)); };
    CHECK(metres() == doctest::Approx(0.98));
    step(SetViewerPose{behind(0.25)});
    CHECK(metres() == doctest::Approx(1.23));
    Wearer wearer = history.current().wearer;
    wearer.lensToPupil = 30.0_mm;
    step(SetWearer{wearer});
    CHECK(metres() == doctest::Approx(1.22));
    step(SetPixelScale{{50.0, PixelScale::Source::typed}});
    CHECK(history.current().scene.measured->camera.fx == 35.0);  // measured, not guessed: it stays
    history.undo();
    history.undo();
    CHECK(metres() == doctest::Approx(1.23));
    history.undo();
    CHECK(metres() == doctest::Approx(0.98));
    CHECK(history.redoLabel() == "Move the wearer");
}

TEST_CASE("measured depth: a camera guessed from the field of view follows it") {
    Document document = newDocument(sceneOf(kSize));
    MeasuredDepth measured = measuredAt(1.0F);
    measured.camera = plainPinhole(kSize, document.scene.scale.focalPixels);
    document = *edited(document, SetMeasuredDepth{Box(measured)});
    document = *edited(document, SetPixelScale{{60.0, PixelScale::Source::typed}});
    CHECK(document.scene.measured->camera.fx == 60.0);
}

TEST_CASE("measured depth: steps of another length scale what was measured") {
    MeasuredDepth measured = measuredAt(1.5F);
    measured.step = 1.0_mm;
    Document document = newDocument(sceneOf(kSize));
    document = *edited(document, SetMeasuredDepth{Box(measured)});
    const Document scaled = *edited(document, SetDepthScale{0.2_mm});
    CHECK(scaled.scene.measured->metres.at(0, 0) == doctest::Approx(0.3));
    CHECK(scaled.scene.depth->metres.at(0, 0) == doctest::Approx(0.28));
    CHECK(edited(scaled, SetDepthScale{1.0_mm})->scene == document.scene);
    CHECK_FALSE(edited(withDepth(1.0F), SetDepthScale{1.0_mm}));
}

TEST_CASE("measured depth: refusals name the cause and change nothing") {
    const Document document = withDepth(1.0F);
    const auto refusal = [&](const Edit& edit) {
        const auto next = edited(document, edit);
        return next ? std::string() : next.error().what;
    };
    CHECK(refusal(SetViewerPose{behind(-2.0)}) ==
          "Nothing of the depth map is in front of the wearer's lens there: move them away from what was measured, or "
          "turn them towards it.");
    ViewerPose skewed;
    skewed.viewerFromCamera.rotation[0] = 2.0;
    CHECK(refusal(SetViewerPose{skewed}).starts_with("The wearer's place must be within 100 m"));
    skewed = behind(std::nan(""));
    CHECK(refusal(SetViewerPose{skewed}).starts_with("The wearer's place must be within 100 m"));
    CHECK(refusal(SetMeasuredDepth{}) ==
          "\"Hands\" reads its distance from the depth map: give it another distance before the map goes.");
    CHECK(refusal(SetMeasuredDepth{Box(measuredAt(0.0F))}).starts_with("The depth map holds only holes"));
    CHECK(refusal(SetMeasuredDepth{Box(measuredAt(NAN))}).find("no distances") != std::string::npos);
    MeasuredDepth small = measuredAt(1.0F);
    small.metres = Image<float>({2, 1}, 1, {1.0F, 1.0F});
    CHECK(refusal(SetMeasuredDepth{Box(small)}).starts_with("The depth map has 2 x 1 pixels"));
    MeasuredDepth blind = measuredAt(1.0F);
    blind.camera.fx = 0.0;
    CHECK(refusal(SetMeasuredDepth{Box(blind)}).starts_with("The camera of the depth map needs focal lengths"));
    Wearer wearer = document.wearer;
    wearer.lensToPupil = 60.0_mm;
    const Document near = *edited(document, SetViewerPose{behind(-0.94)});
    CHECK_FALSE(edited(near, SetWearer{wearer}));
    const auto without = edited(*edited(document, SetDistance{"b", ConstantDistance{0.5_m, {}}}), SetMeasuredDepth{});
    REQUIRE(without);
    CHECK_FALSE(without->scene.depth);
}

TEST_CASE("distance: a less certain depth map never makes the range narrower") {
    law("any noise, any uncertainties", [] {
        const double less = *rc::gen::inRange(0, 50) * 1e-3, more = less + *rc::gen::inRange(0, 50) * 1e-3;
        std::mt19937 random(static_cast<unsigned>(*rc::gen::inRange(0, 1000)));
        std::uniform_real_distribution<float> metres(0.3F, 0.9F);
        MeasuredDepth measured = measuredAt(1.0F);
        std::vector<float> values(std::size_t{40} * 24);
        for (float& v : values)
            v = metres(random);
        measured.metres = Image<float>(kSize, 1, std::move(values));
        const auto range = [&](double sigma) {
            MeasuredDepth one = measured;
            if (sigma > 0.0) {
                one.sigma = Image<float>(kSize, 1, std::vector<float>(std::size_t{40} * 24, static_cast<float>(sigma)));
            }
            Document document = *edited(withDepth(1.0F), SetMeasuredDepth{Box(one)});
            document = *edited(document, FillShape{"b", Rectangle{{0, 0}, {40, 24}}});
            return *distanceRange(document, *findRegion(document, "b"));
        };
        const DistanceRange a = range(less), b = range(more);
        RC_ASSERT(b.nearest <= a.nearest);
        RC_ASSERT(b.farthest >= a.farthest);
        RC_ASSERT(b.nearest > 0.0_m);
        RC_ASSERT(std::abs(b.sigma.si() - more) < 1e-6);
    });
}

TEST_CASE("distance: depth maps keep a thousandth of a dioptre from 0.1 m to 100 m, and come back as whole steps") {
    for (const double metres : {0.1, 0.25, 1.0, 20.0, 100.0}) {
        const DepthMap map = wearerDistances(measuredAt(static_cast<float>(metres + 0.02)), {}, {});
        CHECK(std::abs(1.0 / static_cast<double>(map.metres.at(0, 0)) - 1.0 / metres) < 1e-4);
    }
    const Image<std::uint16_t> raw({4, 1}, 1, {0, 1, 12075, 65535});
    for (const Metre step : {1.0_mm, 0.2_mm, Metre::fromSi(1.0 / 5000.0), 0.1_mm, 1.0_um, 1.0_m})
        CHECK(wholeSteps(depthOf(raw, step)) == raw);
    DepthMap moved = depthOf(raw, 1.0_mm);
    moved.metres = Image<float>({4, 1}, 1, {0.0F, 0.0015F, 1.0F, 2.0F});
    CHECK(wholeSteps(moved).empty());
}

}  // namespace ilf
