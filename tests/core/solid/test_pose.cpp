#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/solid/pose.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

double det(const std::array<double, 9>& m) {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

Pinhole bentCamera() {
    Pinhole camera = plainPinhole({1280, 1024}, 1300.0);
    camera.cx += 12.3;
    camera.fy = 1310.0;
    camera.distortion = {-0.12, 0.05, 0.001, -0.0008, 0.0};
    return camera;
}

std::vector<PosePair> pairsOf(const std::vector<Point3<ModelSpace>>& points, const Pinhole& camera,
                              const Pose<CameraSpace, ModelSpace>& pose) {
    std::vector<PosePair> pairs;
    for (const auto& point : points) {
        const auto at = pose(point);
        const auto [x, y] = camera.pixelOf(at.x / at.z, at.y / at.z);
        pairs.push_back({point, {x, y}});
    }
    return pairs;
}

double farthest(const Pose<CameraSpace, ModelSpace>& a, const Pose<CameraSpace, ModelSpace>& b,
                const std::vector<Point3<ModelSpace>>& points) {
    double most = 0.0;
    for (const auto& point : points) {
        const auto p = a(point), q = b(point);
        most = std::max(most, std::hypot(p.x - q.x, p.y - q.y, p.z - q.z));
    }
    return most;
}

const std::vector<Point3<ModelSpace>> kCorners{{-0.2, -0.1, 0.0}, {0.2, -0.1, 0.05}, {0.2, 0.15, -0.1},
                                               {-0.2, 0.1, 0.1},  {0.0, 0.2, 0.15},  {0.1, 0.0, 0.2}};

std::string refusal(const Result<FoundPose>& found) { return found ? "" : found.error().what; }

}  // namespace

TEST_CASE("The pose that points were seen from is found again") {
    law("four to six points, with lens distortion", [] {
        const int count = *rc::gen::inRange(4, 7);
        const auto hundredths = [](int most) { return *rc::gen::inRange(-most, most) * 0.01; };
        const auto pose = lookingAt({hundredths(60), hundredths(60), 1.0 + 0.01 * *rc::gen::inRange(0, 100)},
                                    {hundredths(10), hundredths(10), 0.0});
        std::vector<Point3<ModelSpace>> points(kCorners.begin(), kCorners.begin() + count);
        const auto found = poseFromPairs(pairsOf(points, bentCamera(), pose), bentCamera());
        RC_ASSERT(found.has_value());
        RC_ASSERT(found->rms_px < 1e-4);
        // Four points of a general shape may have a second exact answer; more decide.
        if (count > 4) RC_ASSERT(farthest(found->cameraFromModel, pose, points) < 1e-5);
    });
}

TEST_CASE("Points of one plane give a pose, and a rival where it can be mirrored") {
    const std::vector<Point3<ModelSpace>> board{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.15, 0}, {0, 0.15, 0}};
    const auto near = lookingAt({0.5, 0.4, 0.5}, {0.1, 0.07, 0.0});
    const auto found = poseFromPairs(pairsOf(board, bentCamera(), near), bentCamera());
    REQUIRE(found);
    CHECK(found->rms_px < 1e-4);
    CHECK(farthest(found->cameraFromModel, near, board) < 1e-5);
    CHECK_FALSE(found->rival_px);
    // From 8 m the perspective of the board is a fraction of a pixel.
    const auto far = lookingAt({3.0, 1.0, 8.0}, {0.1, 0.07, 0.0});
    const auto unsure = poseFromPairs(pairsOf(board, bentCamera(), far), bentCamera());
    REQUIRE(unsure);
    CHECK(unsure->rival_px);
}

TEST_CASE("Residuals are told for each pair, the worst by name") {
    const auto pose = lookingAt({0.3, 0.4, 1.2}, {0, 0, 0});
    auto pairs = pairsOf(kCorners, bentCamera(), pose);
    pairs[3].picture.x += 6.0;
    const auto found = poseFromPairs(pairs, bentCamera());
    REQUIRE(found);
    CHECK(found->residuals_px.size() == 6);
    CHECK(found->worst == 3);
    CHECK(found->rms_px > 0.3);
    CHECK(found->rms_px < 6.0);
}

TEST_CASE("Pairs that fix no pose are refused in words") {
    const auto pose = lookingAt({0.3, 0.4, 1.2}, {0, 0, 0});
    const Pinhole camera = bentCamera();
    auto pairs = pairsOf(kCorners, camera, pose);
    CHECK(refusal(poseFromPairs(std::span(pairs).first(3), camera)).find("at least 4") != std::string::npos);
    std::vector<Point3<ModelSpace>> line;
    for (int i = 0; i < 6; ++i)
        line.push_back({0.1 * i, 0.05 * i, 0.02 * i});
    CHECK(refusal(poseFromPairs(pairsOf(line, camera, pose), camera)).find("line of the scene") != std::string::npos);
    auto spot = pairs;
    for (auto& pair : spot)
        pair.picture = {100.0, 100.0};
    CHECK(refusal(poseFromPairs(spot, camera)).find("picture") != std::string::npos);
    auto odd = pairs;
    odd[0].picture.x = NAN;
    CHECK_FALSE(poseFromPairs(odd, camera));
    auto swapped = pairs;
    for (std::size_t i = 0; i < swapped.size(); ++i)
        swapped[i].picture = {i % 2 == 0 ? 0.0 : 1280.0, i % 3 == 0 ? 1024.0 : 13.0 * static_cast<double>(i)};
    CHECK_FALSE(poseFromPairs(swapped, camera));
    CHECK_FALSE(poseFromPairs(pairs, Pinhole{}));
}

TEST_CASE("A glTF node's camera looks along its -z with its y upwards, whatever its scale") {
    // Turned a quarter about y: looks along -x of the scene; twice as large.
    const std::array<double, 16> node{0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 5, 6, 7, 1};
    const auto pose = cameraFromGltfNode(node);
    REQUIRE(pose);
    CHECK(det(pose->rotation) == doctest::Approx(1.0));
    const auto ahead = (*pose)({3.0, 6.0, 7.0}), above = (*pose)({5.0, 7.0, 7.0}), beside = (*pose)({5.0, 6.0, 6.0});
    CHECK(ahead.z == doctest::Approx(2.0));
    CHECK(above.y == doctest::Approx(-1.0));
    CHECK(beside.x == doctest::Approx(1.0));
    CHECK_FALSE(cameraFromGltfNode({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
}

TEST_CASE("A camera that looks at a point sees it in the middle, and up above it") {
    law("lookingAt", [] {
        const auto tenth = [] { return *rc::gen::inRange(-50, 50) * 0.1; };
        const Point3<ModelSpace> eye{tenth(), tenth(), tenth()}, target{tenth(), tenth(), tenth()};
        RC_PRE(std::hypot(eye.x - target.x, eye.y - target.y, eye.z - target.z) > 0.05);
        const auto pose = lookingAt(eye, target);
        const auto at = pose(target);
        RC_ASSERT(std::abs(det(pose.rotation) - 1.0) < 1e-12);
        RC_ASSERT(std::hypot(at.x, at.y) < 1e-9 && at.z > 0.0);
        const auto higher = pose({target.x, target.y + 0.01, target.z});
        RC_ASSERT(higher.y <= 1e-12);
    });
}
