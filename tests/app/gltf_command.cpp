// `gltf info` and `gltf depth`: what scripts read of a scene.
#include "app/headless/gltf_command.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/exit_code.h"
#include "core/solid/pose.h"
#include "projects/depth_file.h"
#include "projects/pictures.h"
#include "tests/projects/made_gltf.h"

using namespace ilf;
using namespace ilf::app;
using nlohmann::json;

namespace {

/// The square, its JSON open to be spoilt.
struct MadeGltf : MadeSquare {
    nlohmann::json json = nlohmann::json::parse(kJson);

    Result<projects::GltfScene> read() const { return readAs(json.dump()); }
};

/// What a command writes to a stream while it lives.
class Heard {
public:
    explicit Heard(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
    ~Heard() { stream_.rdbuf(before_); }
    Heard(const Heard&) = delete;
    Heard& operator=(const Heard&) = delete;
    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::ostream& stream_;
    std::streambuf* before_;
};

/// A square metre at z = 0 with a camera 2 m before its middle.
struct WithCamera : MadeGltf {
    WithCamera() {
        json["cameras"] =
            nlohmann::json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}])");
        json["nodes"] = nlohmann::json::parse(R"([{"mesh": 0}, {"camera": 0, "translation": [0.5, 0.5, 2]}])");
        json["scenes"][0]["nodes"] = {0, 1};
        REQUIRE(read());
    }
};

GltfDepthOptions depthOptions(const MadeGltf& made, const std::string& out) {
    GltfDepthOptions options;
    options.file = (made.folder / "scene.gltf").string();
    options.size = "64x48";
    options.out = (made.folder / out).string();
    return options;
}

MeasuredDepth depthIn(const std::string& file) {
    projects::DepthReading reading;
    reading.picture = {64, 48};
    reading.focalPixels = 50.0;
    reading.step = 1.0_mm;
    const auto depth = projects::readDepth(file, reading);
    REQUIRE_MESSAGE(depth, depth.error().what);
    return depth->measured;
}

}  // namespace

TEST_CASE("gltf info --json: triangles, box, problems, meshes and cameras") {
    const WithCamera made;
    const Heard out(std::cout);
    REQUIRE(gltfInfoCommand((made.folder / "scene.gltf").string(), true) == kDone);
    const json told = json::parse(out.text());
    CHECK(told["triangles"] == 2);
    CHECK(told["bbox_min"] == json({0.0, 0.0, 0.0}));
    CHECK(told["bbox_max"] == json({1.0, 1.0, 0.0}));
    CHECK(told["problems"].empty());
    CHECK(told["meshes"][0]["name"] == "square");
    CHECK(told["cameras"][0]["position"][2].get<double>() == doctest::Approx(2.0));
    CHECK(told["cameras"][0]["looks_along"][2].get<double>() == doctest::Approx(-1.0));
}

TEST_CASE("gltf info: a refused file ends with 1, a sentence and, as JSON, the same sentence") {
    MadeGltf made;
    made.indices[0] = 7;
    REQUIRE_FALSE(made.read());
    const Heard out(std::cout), complaint(std::cerr);
    CHECK(gltfInfoCommand((made.folder / "scene.gltf").string(), true) == kFailed);
    const json told = json::parse(out.text());
    CHECK(told["refused"] == true);
    REQUIRE(told["problems"].size() == 1);
    CHECK(told["problems"][0].get<std::string>().find("vertex 7 of 4") != std::string::npos);
    CHECK(complaint.text().find("vertex 7 of 4") != std::string::npos);
}

TEST_CASE("gltf depth: the file's camera, in each format, and a picture") {
    const WithCamera made;
    const Heard out(std::cout);
    for (const char* name : {"depth.png", "depth.pfm", "depth.exr"}) {
        CAPTURE(name);
        GltfDepthOptions options = depthOptions(made, name);
        options.camera = 0;
        options.colour = (made.folder / "seen.png").string();
        REQUIRE(gltfDepthCommand(options) == kDone);
        const MeasuredDepth depth = depthIn(options.out);
        CHECK(static_cast<double>(depth.metres.at(32, 24)) == doctest::Approx(2.0));
        CHECK(depth.metres.at(1, 1) == 0.0F);
        const auto picture = projects::readPicture(options.colour);
        REQUIRE(picture);
        CHECK(picture->picture.at(32, 24) > 0);
        CHECK(picture->picture.at(1, 1) == 0);
    }
    CHECK(out.text().find("one step is 1 mm") != std::string::npos);
}

TEST_CASE("gltf depth: a typed pose, and one from point pairs") {
    const WithCamera made;
    const Heard out(std::cout);
    GltfDepthOptions typed = depthOptions(made, "typed.pfm");
    typed.pose = "0.5, 0.5, 3, 0.5, 0.5, 0";
    REQUIRE(gltfDepthCommand(typed) == kDone);
    CHECK(static_cast<double>(depthIn(typed.out).metres.at(32, 24)) == doctest::Approx(3.0));

    const Pinhole camera = plainPinhole({64, 48}, 60.0);
    const auto pose = lookingAt({1.2, 0.9, 2.0}, {0.5, 0.5, 0.0});
    std::ostringstream csv;
    csv.precision(12);
    csv << "x,y,z,u,v\n";
    for (const Point3<ModelSpace>& point :
         {Point3<ModelSpace>{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.3}}) {
        const auto at = pose(point);
        const auto [u, v] = camera.pixelOf(at.x / at.z, at.y / at.z);
        csv << point.x << ',' << point.y << ',' << point.z << ',' << u << ',' << v << '\n';
    }
    GltfDepthOptions paired = depthOptions(made, "paired.pfm");
    paired.pairs = made.folder.put("pairs.csv", csv.str()).string();
    paired.focal_px = 60.0;
    REQUIRE(gltfDepthCommand(paired) == kDone);
    const auto middle = pose({0.5, 0.5, 0.0});
    CHECK(static_cast<double>(depthIn(paired.out).metres.at(31, 23)) == doctest::Approx(middle.z).epsilon(0.02));
    CHECK(out.text().find("5 pairs") != std::string::npos);
}

TEST_CASE("gltf depth refuses what cannot be drawn") {
    const WithCamera made;
    const Heard out(std::cout), complaint(std::cerr);
    GltfDepthOptions options = depthOptions(made, "no.pfm");
    options.camera = 3;
    CHECK(gltfDepthCommand(options) == kFailed);
    CHECK(complaint.text().find("no camera 3") != std::string::npos);
    options.pose = "1,2,3";
    CHECK(gltfDepthCommand(options) == kUsage);  // a camera and a pose
    options.camera = -1;
    CHECK(gltfDepthCommand(options) == kFailed);
    options.pose = "1,1,1,1,1,1";
    CHECK(gltfDepthCommand(options) == kFailed);
    options.pose.clear();
    options.size = "0x4";
    CHECK(gltfDepthCommand(options) == kUsage);
    CHECK_FALSE(std::filesystem::exists(made.folder / "no.pfm"));
}
