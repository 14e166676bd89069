#include <doctest/doctest.h>

#include <algorithm>

#include "core/registration/calibrate.h"
#include "tests/core/registration/procam_truth.h"
#include "tests/support/law.h"

namespace {

using namespace ilf;

/// The largest error of a pinhole's four numbers as a share of its focal length.
double worstShare(const Pinhole& found, const Pinhole& truth) {
    return std::max({std::abs(found.fx - truth.fx), std::abs(found.fy - truth.fy), std::abs(found.cx - truth.cx),
                     std::abs(found.cy - truth.cy)}) /
           truth.fx;
}
double focalShare(const Pinhole& found, const Pinhole& truth) {
    return std::max(std::abs(found.fx - truth.fx), std::abs(found.fy - truth.fy)) / truth.fx;
}

/// The angle between two turns, degrees.
template <class P>
double apart_deg(const P& a, const P& b) {
    double trace = 0.0;
    for (std::size_t i = 0; i < 9; ++i)
        trace += a.rotation[i] * b.rotation[i];
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0)) * 57.29577951308232;
}

double apart_m(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("calibration: exact corners give the exact numbers, with the projector's axis through its raster's edge") {
    truth::Procam procam;
    procam.camera.p1 = procam.camera.p2 = 0.0;  // with exact corners every term is found: those that are there
    const auto found = calibrated(truth::viewsOf(procam, truth::fivePoses(), 0.0, 1), truth::kBoard);
    REQUIRE_MESSAGE(found, found.error().what);
    CHECK(worstShare(found->calibration.camera, procam.camera.pinhole()) < 1e-5);
    CHECK(worstShare(found->calibration.projector, procam.projector.pinhole()) < 1e-5);
    CHECK(found->calibration.camera.distortion[0] == doctest::Approx(procam.camera.k1).epsilon(1e-3));
    CHECK(apart_deg(found->calibration.projectorFromCamera, procam.projectorFromCamera) < 1e-3);
    CHECK(apart_m(found->calibration.projectorFromCamera.translation, procam.projectorFromCamera.translation) < 1e-5);
    CHECK(found->calibration.cameraRms_px < 1e-3);
    CHECK(found->widestTilt_deg == doctest::Approx(67.0).epsilon(0.05));
    CHECK(found->calibration.scale == "board");
}

TEST_CASE("calibration: five poses with 0.1 px of noise give focal lengths to 0.3 % and say how certain they are") {
    const truth::Procam procam;
    double worst = 0.0, camera2 = 0.0, projector2 = 0.0, chi2 = 0.0;
    constexpr int kSeeds = 24;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        const auto found = calibrated(truth::viewsOf(procam, truth::fivePoses(), 0.1, seed), truth::kBoard);
        REQUIRE_MESSAGE(found, found.error().what);
        const ProcamCalibration& c = found->calibration;
        worst = std::max({worst, focalShare(c.camera, procam.camera.pinhole()),
                          focalShare(c.projector, procam.projector.pinhole())});
        CHECK(worstShare(c.projector, procam.projector.pinhole()) < 0.006);
        CHECK(worstShare(c.camera, procam.camera.pinhole()) < 0.003);
        CHECK(apart_deg(c.projectorFromCamera, procam.projectorFromCamera) < 0.25);
        CHECK(apart_m(c.projectorFromCamera.translation, procam.projectorFromCamera.translation) < 0.003);
        CHECK(c.cameraRms_px == doctest::Approx(0.1414).epsilon(0.1));
        CHECK(c.projectorRms_px == doctest::Approx(0.1414).epsilon(0.1));
        camera2 += std::pow((c.camera.fx - procam.camera.fx) / found->camera.fx, 2) / kSeeds;
        projector2 += std::pow((c.projector.fx - procam.projector.fx) / found->projector.fx, 2) / kSeeds;
        for (std::size_t i = 0; i < 3; ++i) {
            chi2 += std::pow((c.projectorFromCamera.translation[i] - procam.projectorFromCamera.translation[i]) /
                                 found->translation_m[i],
                             2) /
                    (3 * kSeeds);
        }
    }
    MESSAGE("worst focal length " << 100.0 * worst << " %; squared errors over variances: camera " << camera2
                                  << ", projector " << projector2 << ", translation " << chi2);
    CHECK(worst < 0.003);
    // Of 24 squared standard normal numbers the mean lies within 0.4 and 1.9 in 99 of 100 cases.
    for (const double share : {camera2, projector2, chi2}) {
        CHECK(share > 0.4);
        CHECK(share < 1.9);
    }
}

TEST_CASE("calibration: a board twice as large is a room twice as large, in the same pixels") {
    const truth::Procam procam;
    const auto views = truth::viewsOf(procam, truth::fivePoses(), 0.1, 3);
    Board twice = truth::kBoard;
    twice.square = 2.0 * twice.square;
    const auto once = calibrated(views, truth::kBoard), big = calibrated(views, twice);
    REQUIRE(once);
    REQUIRE(big);
    CHECK(big->calibration.camera.fx == doctest::Approx(once->calibration.camera.fx).epsilon(1e-5));
    CHECK(big->calibration.projector.fy == doctest::Approx(once->calibration.projector.fy).epsilon(1e-5));
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(big->calibration.projectorFromCamera.translation[i] ==
              doctest::Approx(2.0 * once->calibration.projectorFromCamera.translation[i]).epsilon(1e-3));
    }
    SUBCASE("and one tape measure says the same") {
        const auto taped = rescaled(once->calibration, 0.5_m, 1.0_m);
        REQUIRE(taped);
        CHECK(taped->scale == "tape");
        CHECK(taped->camera == once->calibration.camera);
        CHECK(taped->projectorFromCamera.rotation == once->calibration.projectorFromCamera.rotation);
        CHECK(taped->projectorFromCamera.translation[0] ==
              doctest::Approx(2.0 * once->calibration.projectorFromCamera.translation[0]));
        CHECK_FALSE(rescaled(once->calibration, 0.0_m, 1.0_m));
        CHECK_FALSE(rescaled(once->calibration, 1.0_m, Metre::fromSi(std::nan(""))));
    }
}

TEST_CASE("calibration: one pose, and poses that are parallel, are refused with the reason") {
    const truth::Procam procam;
    const auto one = calibrated(truth::viewsOf(procam, {truth::fivePoses()[1]}, 0.1, 1), truth::kBoard);
    REQUIRE_FALSE(one);
    CHECK(one.error().what.find("One pose of the board cannot tell a camera's focal length") != std::string::npos);
    CHECK(one.error().what.find("five poses") != std::string::npos);
    CHECK_FALSE(calibrated(std::span<const BoardView>{}, truth::kBoard));

    const std::vector<truth::BoardAt> flat{
        {0, 0, 0, 0, 0, 0.9}, {0, 0, 20, 0.03, 0, 1.0}, {0, 0, -15, -0.02, 0.02, 1.1}};
    const std::vector<truth::BoardAt> tilted{
        {25, 10, 0, 0, 0, 0.9}, {25, 10, 0, 0.05, 0, 1.0}, {25, 10, 0, -0.05, 0.02, 1.1}};
    for (const auto& poses : {flat, tilted}) {
        const auto refused = calibrated(truth::viewsOf(procam, poses, 0.1, 1), truth::kBoard);
        REQUIRE_FALSE(refused);
        INFO(refused.error().what);
        CHECK(refused.error().what.find("nearly parallel") != std::string::npos);
        CHECK(refused.error().what.find("tilted") != std::string::npos);
        CHECK_FALSE(calibratedCamera(truth::viewsOf(procam, poses, 0.1, 1), truth::kBoard));
    }
}

TEST_CASE("calibration: views of different frames or boards are refused") {
    const truth::Procam procam;
    auto views = truth::viewsOf(procam, truth::fivePoses(), 0.1, 1);
    views[3].camera.width = 640;
    const auto mixed = calibrated(views, truth::kBoard);
    REQUIRE_FALSE(mixed);
    CHECK(mixed.error().what.find("pose 4") != std::string::npos);
    views = truth::viewsOf(procam, truth::fivePoses(), 0.1, 1);
    views[2].inCamera.pop_back();
    CHECK_FALSE(calibrated(views, truth::kBoard));
    CHECK_FALSE(calibrated(truth::viewsOf(procam, truth::fivePoses(), 0.1, 1), Board{9, 7, 0.0_m}));
}

TEST_CASE("calibration: a board that moved during its scan is named and left out") {
    const truth::Procam procam;
    auto poses = truth::fivePoses();
    poses.push_back({15, -20, 10, 0.02, 0.04, 1.02});
    auto views = truth::viewsOf(procam, poses, 0.1, 5);
    for (std::size_t i = 0; i < views[2].onProjector.size(); ++i)  // its rows were decoded 4 mm on, on average
        views[2].onProjector[i]->y += i % 2 == 0 ? 9.0 : 3.0;
    const auto found = calibrated(views, truth::kBoard);
    REQUIRE_MESSAGE(found, found.error().what);
    CHECK_FALSE(found->poses[2].used);
    CHECK(std::ranges::count_if(found->poses, &PoseFit::used) == 5);
    CHECK(found->calibration.poses == 5);
    REQUIRE_FALSE(found->notes.empty());
    CHECK(found->notes.front().find("pose 3") != std::string::npos);
    CHECK(focalShare(found->calibration.projector, procam.projector.pinhole()) < 0.003);
}

TEST_CASE("calibration: few poses carry few terms of distortion, and a lens that bends nothing gets none") {
    truth::Procam procam;
    auto poses = truth::fivePoses();
    poses.resize(3);
    const auto three = calibrated(truth::viewsOf(procam, poses, 0.1, 2), truth::kBoard);
    REQUIRE_MESSAGE(three, three.error().what);
    for (const std::size_t term : {1U, 2U, 3U, 4U})
        CHECK(three->calibration.camera.distortion[term] == 0.0);
    CHECK(three->notes.front().find("distortion is restrained") != std::string::npos);
    CHECK(three->camera.distortion[4] == 0.0);

    procam.camera.k1 = procam.camera.k2 = procam.camera.p1 = procam.camera.p2 = 0.0;
    procam.projector.k1 = procam.projector.k2 = 0.0;
    const auto straight = calibrated(truth::viewsOf(procam, truth::fivePoses(), 0.1, 2), truth::kBoard);
    REQUIRE(straight);
    CHECK(straight->calibration.camera.distortion == std::array<double, 5>{});
    CHECK(straight->calibration.projector.distortion == std::array<double, 5>{});
}

TEST_CASE("calibration: corners without a place on the projector do no harm") {
    const truth::Procam procam;
    auto views = truth::viewsOf(procam, truth::fivePoses(), 0.1, 9);
    for (BoardView& view : views)
        for (std::size_t i = 0; i < view.onProjector.size(); i += 3)
            view.onProjector[i].reset();
    const auto found = calibrated(views, truth::kBoard);
    REQUIRE_MESSAGE(found, found.error().what);
    CHECK(found->poses[0].projectorCorners == 42);
    CHECK(focalShare(found->calibration.projector, procam.projector.pinhole()) < 0.004);
}
