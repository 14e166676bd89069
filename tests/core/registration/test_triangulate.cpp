#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/registration/triangulate.h"
#include "tests/core/registration/procam_truth.h"

namespace {

using namespace ilf;

/// A quarter of each side: what is checked is the same for every pixel.
truth::Procam small() {
    truth::Procam p;
    for (truth::Lens* lens : {&p.camera, &p.projector}) {
        lens->size = {lens->size.width / 4, lens->size.height / 4};
        lens->fx /= 4, lens->fy /= 4, lens->cx /= 4, lens->cy /= 4;
    }
    return p;
}

TriangulateOptions withNoise(double px) {
    TriangulateOptions options;
    options.match_px = px;
    options.common = 0.0;  // the calibration is exact
    return options;
}

struct Errors {
    double worstShare = 0.0, chi2 = 0.0, rmsShare = 0.0;
    int count = 0;
};

Errors errorsOf(const MeasuredDepth& depth, const std::vector<double>& truth) {
    Errors e;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double z = depth.metres.pixels()[i];
        if (z == 0.0) continue;
        const double off = z - truth[i];
        e.worstShare = std::max(e.worstShare, std::abs(off) / truth[i]);
        e.rmsShare += off * off / (truth[i] * truth[i]);
        e.chi2 += off * off / std::pow(static_cast<double>(depth.sigma.pixels()[i]), 2);
        ++e.count;
    }
    e.rmsShare = std::sqrt(e.rmsShare / e.count), e.chi2 /= e.count;
    return e;
}

}  // namespace

TEST_CASE("triangulation: exact places give the exact depth, also of a slanted plane") {
    const truth::Procam procam = small();
    for (const auto& plane : {std::array{1.0, 0.0, 0.0}, std::array{0.8, 0.4, -0.3}, std::array{2.5, -0.2, 0.5}}) {
        std::vector<double> truth;
        const auto scan = truth::scanOf(procam, plane[0], plane[1], plane[2], 0.0, 1, truth);
        const auto found = triangulated(scan, procam.calibration(), withNoise(0.1));
        REQUIRE_MESSAGE(found, found.error().what);
        const Errors e = errorsOf(found->depth, truth);
        MESSAGE("plane at " << plane[0] << " m: worst error " << 100.0 * e.worstShare << " %, " << e.count
                            << " pixels");
        CHECK(e.count > 10000);
        CHECK(found->missed == 0);
        CHECK(e.count == found->measured);
        CHECK(e.worstShare < 2e-4);
        CHECK(found->missRms_px < 0.01);
        CHECK(found->depth.camera == procam.camera.pinhole());
        CHECK(found->depth.provenance == "simulated");
    }
}

TEST_CASE("triangulation: with a quarter of a pixel of noise, depth at 1 m is good to 0.5 % and sigma is its spread") {
    const truth::Procam procam;
    std::vector<double> truth;
    const auto scan = truth::scanOf(procam, 1.0, 0.1, 0.05, 0.25, 7, truth);
    const auto found = triangulated(scan, procam.calibration(), withNoise(0.25));
    REQUIRE_MESSAGE(found, found.error().what);
    const Errors e = errorsOf(found->depth, truth);
    MESSAGE("rms " << 100.0 * e.rmsShare << " %, worst " << 100.0 * e.worstShare << " %, chi2 " << e.chi2 << ", miss "
                   << found->missRms_px << " px, " << e.count << " pixels");
    CHECK(e.rmsShare < 0.005);
    CHECK(e.chi2 == doctest::Approx(1.0).epsilon(0.02));
    CHECK(found->missRms_px == doctest::Approx(0.25).epsilon(0.02));
    // Of normal misses 6 in 100000 lie beyond four deviations.
    CHECK(found->missed < 2e-4 * found->measured);
}

TEST_CASE("triangulation: a calibration from five noisy poses still gives depth to 0.5 % at 1 m") {
    const truth::Procam procam;
    std::vector<double> truth;
    const auto scan = truth::scanOf(procam, 1.0, 0.0, 0.0, 0.1, 3, truth);
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const auto calibration = calibrated(truth::viewsOf(procam, truth::fivePoses(), 0.1, seed), truth::kBoard);
        REQUIRE(calibration);
        const auto found = triangulated(scan, calibration->calibration, withNoise(0.1));
        REQUIRE_MESSAGE(found, found.error().what);
        const Errors e = errorsOf(found->depth, truth);
        MESSAGE("rms " << 100.0 * e.rmsShare << " %, miss " << found->missRms_px << " px");
        CHECK(e.rmsShare < 0.005);
        CHECK(e.count > 0.95 * found->measured);
    }
}

TEST_CASE("triangulation: wrong places are holes, not depths") {
    const truth::Procam procam = small();
    std::vector<double> truth;
    const auto scan = truth::scanOf(procam, 1.0, 0.0, 0.0, 0.0, 1, truth);
    std::vector<float> places(scan.projectorOfCamera.pixels().begin(), scan.projectorOfCamera.pixels().end());
    int wrong = 0;
    for (std::size_t i = 0; i < truth.size(); i += 50)
        if (truth[i] > 0.0) places[2 * i + 1] += 20.0f, ++wrong;  // across the epipolar lines
    DecodedScan damaged = scan;
    damaged.projectorOfCamera = Image<float>(scan.projectorOfCamera.size(), 2, std::move(places));
    const auto found = triangulated(damaged, procam.calibration(), withNoise(0.25));
    REQUIRE_MESSAGE(found, found.error().what);
    CHECK(found->missed == wrong);
    for (std::size_t i = 0; i < truth.size(); i += 50)
        CHECK(found->depth.metres.pixels()[i] == 0.0f);
}

TEST_CASE("triangulation: what cannot be measured is refused with the reason") {
    const truth::Procam procam = small();
    std::vector<double> truth;
    const auto scan = truth::scanOf(procam, 1.0, 0.0, 0.0, 0.0, 1, truth);
    ProcamCalibration c = procam.calibration();
    SUBCASE("camera and projector in one place") {
        c.projectorFromCamera.translation = {1e-4, 0, 0};
        const auto refused = triangulated(scan, c);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().what.find("too near each other") != std::string::npos);
    }
    SUBCASE("another camera mode") {
        c.camera.size = {1280, 1024};
        const auto refused = triangulated(scan, c);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().what.find("320 x 256") != std::string::npos);
    }
    SUBCASE("another projector") {
        c.projector.size = {1024, 768};
        CHECK_FALSE(triangulated(scan, c));
    }
    SUBCASE("a rig that was moved since") {
        c.projectorFromCamera.rotation = truth::turned(14.0, 13.0, 1.0);
        const auto refused = triangulated(scan, c);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().what.find("Calibrate again") != std::string::npos);
    }
}

TEST_CASE("triangulation: metres follow the scale of the calibration") {
    const truth::Procam procam = small();
    std::vector<double> truth;
    const auto scan = truth::scanOf(procam, 1.0, 0.0, 0.0, 0.0, 1, truth);
    const auto once = triangulated(scan, procam.calibration());
    const auto twice = triangulated(scan, *rescaled(procam.calibration(), 1.0_m, 2.0_m));
    REQUIRE(once);
    REQUIRE(twice);
    for (std::size_t i = 0; i < truth.size(); i += 97) {
        CHECK(twice->depth.metres.pixels()[i] == doctest::Approx(2.0f * once->depth.metres.pixels()[i]));
    }
}
