// Real depth cameras' frames, from file to distances, surfaces and planes.
#include <doctest/doctest.h>

#include "core/document/edit.h"
#include "core/document/plane_fit.h"
#include "core/document/select_depth.h"
#include "projects/depth_file.h"
#include "projects/pictures.h"
#include "tests/support/test_data.h"

namespace ilf::projects {

namespace {

/// A frame of an RGB-D camera as an operator would load it; nothing without the test data.
std::optional<Document> frame(const std::string& colour, const std::string& depth) {
    const auto picture = testData("02_depth/" + colour), map = testData("02_depth/" + depth),
               camera = testData("02_depth/open3d_redwood/camera_primesense.json");
    if (!picture || !map || !camera) return std::nullopt;
    const auto file = readPicture(*picture);
    REQUIRE(file);
    Scene scene;
    scene.picture = Box<Picture>(file->picture);
    DepthReading reading;
    reading.picture = scene.size();
    reading.intrinsics = *readIntrinsics(*camera);  // 525 px, as the TUM benchmark's own default
    const auto read = readDepth(*map, reading);
    REQUIRE(read);
    return *edited(newDocument(scene), SetMeasuredDepth{Box<MeasuredDepth>(read->measured)});
}

Document selected(const Document& document, Point<CameraFrame> at) {
    const auto mask = surfaceAt(*document.scene.depth, *document.scene.picture, at);
    REQUIRE_MESSAGE(mask.has_value(), (mask ? std::string() : mask.error().what));
    Region region;
    region.id = "surface";
    region.name = "Surface";
    region.mask = *mask;
    return *edited(document, AddRegion{region, 0});
}

double areaOf(const Document& document) {
    const Image<std::uint8_t> mask = toImage(findRegion(document, "surface")->mask);
    double area = 0.0;
    for (const std::uint8_t v : mask.pixels())
        area += v / 255.0;
    return area;
}

}  // namespace

TEST_CASE("real depth: the floor of a living room is one click, flat to a centimetre, and ends at wall and chair") {
    const auto room = frame("open3d_redwood/RGBD/color/00000.jpg", "open3d_redwood/RGBD/depth/00000.png");
    if (!room) return;
    const Document floor = selected(*room, {320.5, 380.5});
    const Region& region = *findRegion(floor, "surface");
    CHECK(areaOf(floor) > 55'000.0);
    CHECK(areaOf(floor) < 66'000.0);
    CHECK(region.mask.at(150, 430) == 255);
    for (const auto& [x, y] : {std::pair{300, 200}, {450, 310}, {395, 260}, {150, 200}, {630, 250}})
        CHECK(region.mask.at(x, y) == 0);  // wall, skirting board, chair, bricks, cupboard
    const auto plane = fittedPlane(floor, region);
    REQUIRE_MESSAGE(plane.has_value(), (plane ? std::string() : plane.error().what));
    CHECK(plane->rms < 10.0_mm);
    CHECK(plane->inliers > 0.98);
    // The plane says what the map says, from the wearer's lens.
    Region flat = region;
    flat.distance = plane->distance;
    const Point<CameraFrame> at{320.5, 400.5};
    const double measured = static_cast<double>(floor.scene.measured->metres.at(320, 400));
    CHECK(floor.scene.depth->metres.at(320, 400) == doctest::Approx(measured - 0.02));
    CHECK(distanceAt(floor, flat, at)->si() == doctest::Approx(measured - 0.02).epsilon(0.01));
}

TEST_CASE("real depth: at a desk, floor, desk and partition are surfaces of their own") {
    const auto office = frame("tum/TUM_color.png", "tum/TUM_depth.png");
    if (!office) return;
    const Document floor = selected(*office, {250.5, 380.5});
    CHECK(areaOf(floor) > 60'000.0);
    CHECK(findRegion(floor, "surface")->mask.at(450, 215) == 0);
    CHECK(findRegion(floor, "surface")->mask.at(450, 80) == 0);
    const Document partition = selected(*office, {450.5, 80.5});
    CHECK(areaOf(partition) > 30'000.0);
    CHECK(findRegion(partition, "surface")->mask.at(450, 215) == 0);
    CHECK(findRegion(partition, "surface")->mask.at(250, 380) == 0);
}

}  // namespace ilf::projects
