#include "core/document/plane_fit.h"

#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/document/edit.h"
#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kSize{320, 200};

/// The camera's depth of the plane z = at + right X + down Y (metres), with noise of one standard deviation, as far as
/// it is in front; `other` of its pixels belong to something 0.15 m nearer.
MeasuredDepth planeDepth(double at, double right, double down, double noise, double other, unsigned seed) {
    MeasuredDepth measured;
    measured.camera = plainPinhole(kSize, 300.0);
    std::mt19937 random(seed);
    std::normal_distribution<double> off(0.0, noise > 0.0 ? noise : 1.0);
    std::vector<float> metres;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            const auto [sx, sy] = measured.camera.slopesOf(x + 0.5, y + 0.5);
            const double z = at / (1.0 - right * sx - down * sy) + (noise > 0.0 ? off(random) : 0.0);
            const bool cup = std::hypot(x - 200.0, y - 120.0) < std::sqrt(other * 320.0 * 200.0 / 3.14159);
            metres.push_back(static_cast<float>(cup ? z - 0.15 : z));
        }
    }
    measured.metres = Image<float>(kSize, 1, std::move(metres));
    return measured;
}

Document deskOf(const MeasuredDepth& measured) {
    Document document = *edited(twoRegions(), SetMeasuredDepth{Box(measured)});
    return *edited(document, FillShape{"b", Rectangle{{10, 10}, {310, 190}}});
}

std::string refusal(const Document& document, const RegionId& region) {
    const auto plane = fittedPlane(document, *findRegion(document, region));
    return plane ? std::string() : plane.error().what;
}

}  // namespace

TEST_CASE("fitted plane: a slope is found to a millimetre through noise and past what stands on it") {
    law("any slope", [] {
        const double at = *rc::gen::inRange(60, 150) * 0.01, right = *rc::gen::inRange(-5, 6) * 0.1,
                     down = -*rc::gen::inRange(0, 8) * 0.1;
        const double noise = *rc::gen::element(0.0, 0.001, 0.004), cup = *rc::gen::element(0.0, 0.1, 0.3);
        const Document document = deskOf(planeDepth(at, right, down, noise, cup, 7));
        const auto plane = fittedPlane(document, *findRegion(document, "b"));
        if (!plane) RC_FAIL(plane.error().what);
        const Document exact = deskOf(planeDepth(at, right, down, 0.0, 0.0, 7));
        Region onPlane = *findRegion(document, "b");
        onPlane.distance = plane->distance;
        for (const Point<CameraFrame> p : {Point<CameraFrame>{20.5, 20.5}, {160.5, 100.5}, {300.5, 180.5}}) {
            const double fitted = distanceAt(document, onPlane, p)->si();
            const double truth =
                static_cast<double>(exact.scene.depth->metres.at(static_cast<int>(p.x), static_cast<int>(p.y)));
            // Vergence from the lens is affine only to 0.01 D (PlaneDistance): up to 1 cm per square metre.
            RC_ASSERT(std::abs(fitted - truth) < 0.001 + 0.01 * truth * truth + 0.5 * noise);
        }
        RC_ASSERT(plane->inliers > 0.9 - cup);
        RC_ASSERT(plane->rms.si() < 0.008 * at * at + 3.0 * noise + 1e-4);
        RC_ASSERT(plane->distance.tolerance == 2.0 * plane->rms);
    });
}

TEST_CASE("fitted plane: its tolerance brings the region's nearest point nearer") {
    const Document document = deskOf(planeDepth(1.0, 0.0, -0.5, 0.004, 0.0, 3));
    Region region = *findRegion(document, "b");
    auto plane = fittedPlane(document, region);
    REQUIRE(plane);
    region.distance = plane->distance;
    const auto with = distanceRange(document, region);
    plane->distance.tolerance = 0.0_m;
    region.distance = plane->distance;
    const auto without = distanceRange(document, region);
    CHECK((without->nearest - with->nearest).si() == doctest::Approx(2.0 * plane->rms.si()));
    CHECK((with->farthest - without->farthest).si() == doctest::Approx(2.0 * plane->rms.si()));
    CHECK(with->sigma.si() == doctest::Approx(plane->rms.si()));
}

TEST_CASE("fitted plane: refused without depth, on too few pixels, on a thin strip, and where there is no plane") {
    CHECK(refusal(twoRegions(), "b").starts_with("There is no depth map to fit the plane of \"Hands\" to"));
    const MeasuredDepth flat = planeDepth(1.0, 0.0, 0.0, 0.0, 0.0, 1);
    const Document bare = *edited(twoRegions(), SetMeasuredDepth{Box(flat)});
    CHECK(
        refusal(*edited(bare, FillShape{"b", Rectangle{{0, 0}, {5, 5}}}), "b").starts_with("Only 25 measured pixels"));
    CHECK(refusal(*edited(bare, FillShape{"b", Rectangle{{0, 10}, {300, 11}}}), "b").find("too thin") !=
          std::string::npos);
    MeasuredDepth wild = flat;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(0.3F, 3.0F);
    std::vector<float> metres(std::size_t{320} * 200);
    for (float& v : metres)
        v = any(random);
    wild.metres = Image<float>(kSize, 1, std::move(metres));
    CHECK(refusal(deskOf(wild), "b").starts_with("No plane fits"));
}

TEST_CASE("marker plane: a marker seen askew gives its surface's distances from wherever the wearer is") {
    // A marker of 150 mm on the plane z = 0.8 + 0.4 X - 0.3 Y, drawn as the camera sees it.
    const Pinhole camera = plainPinhole(kSize, 300.0);
    const Size big{kSize.width * 4, kSize.height * 4};  // drawn four times as fine, then averaged
    cv::Mat1b marker, page(400, 400, static_cast<std::uint8_t>(255));
    cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250), 7, 240, marker, 1);
    marker.copyTo(page(cv::Rect(80, 80, 240, 240)));
    const double side = 0.15, right = 0.4, down = -0.3, at = 0.8;
    // Axes along the surface, orthonormal.
    const cv::Vec3d ex = cv::normalize(cv::Vec3d(1, 0, right)), n = cv::normalize(cv::Vec3d(-right, -down, 1)),
                    ey = n.cross(ex), middle(0.05, -0.02, at + right * 0.05 + down * -0.02);
    std::vector<cv::Point2f> from, to;
    for (const auto& [px, py] : {std::pair{0, 0}, {400, 0}, {400, 400}, {0, 400}}) {
        const cv::Vec3d p = middle + (px - 200) / 240.0 * side * ex + (py - 200) / 240.0 * side * ey;
        const auto q = camera.pixelOf(p[0] / p[2], p[1] / p[2]);
        from.emplace_back(static_cast<float>(px) - 0.5F, static_cast<float>(py) - 0.5F);
        to.emplace_back(static_cast<float>(4.0 * q[0] - 0.5), static_cast<float>(4.0 * q[1] - 0.5));
    }
    cv::Mat1b drawn, small;
    cv::warpPerspective(page, drawn, cv::getPerspectiveTransform(from, to), {big.width, big.height}, cv::INTER_LINEAR,
                        cv::BORDER_CONSTANT, 200);
    cv::resize(drawn, small, {kSize.width, kSize.height}, 0, 0, cv::INTER_AREA);
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < small.rows; ++y) {
        for (int x = 0; x < small.cols; ++x)
            pixels.insert(pixels.end(), 3, static_cast<std::uint16_t>(small(y, x) * 257));
    }
    Document document = twoRegions();
    Scene scene = document.scene;
    scene.picture = Box(Picture(kSize, 3, std::move(pixels)));
    document = *edited(document, SetScene{scene});
    document = *edited(document, FillShape{"b", Rectangle{{100, 50}, {250, 150}}});
    for (const double back : {0.0, 0.35}) {
        ViewerPose viewer;
        viewer.viewerFromCamera.translation = {0.1, 0, back};
        document = *edited(document, SetViewerPose{viewer});
        const auto plane = markerPlane(document, *findRegion(document, "b"), camera, {"6X6_250", 7, 150.0_mm});
        REQUIRE_MESSAGE(plane.has_value(), (plane ? std::string() : plane.error().what));
        CHECK(plane->rms_px < 0.2);
        CHECK(plane->markerDistance.si() == doctest::Approx(middle[2] + back - 0.02).epsilon(0.01));
        for (const DistanceAnchor& anchor : plane->distance.anchors) {
            const auto [sx, sy] = camera.slopesOf(anchor.at.x, anchor.at.y);
            const double z = at / (1.0 - right * sx - down * sy);
            CHECK(std::abs(anchor.distance.si() - (z + back - 0.02)) < plane->distance.tolerance.si());
        }
        CHECK(plane->distance.tolerance.si() < 0.03);
    }
    const Region& region = *findRegion(document, "b");
    const auto refused = [&](const SurfaceMarker& which) {
        const auto plane = markerPlane(document, region, camera, which);
        return plane ? std::string() : plane.error().what;
    };
    CHECK(refused({"6X6_250", 8, 150.0_mm}).starts_with("Marker 8 of 6X6_250 is not in the picture"));
    CHECK(refused({"9X9", 8, 150.0_mm}).starts_with("There is no marker dictionary \"9X9\""));
    CHECK(refused({"6X6_250", 7, 1.0_mm}).find("from 5 to 2000 mm") != std::string::npos);
    ViewerPose beyond;
    beyond.viewerFromCamera.translation = {0, 0, -3.0};
    document = *edited(document, SetViewerPose{beyond});
    CHECK(refused({"6X6_250", 7, 150.0_mm}).find("not in front of the wearer's lens") != std::string::npos);
}

}  // namespace ilf
