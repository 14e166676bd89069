// Scanned maps in files: read back exactly, readable by OpenCV, and refused in words when something is wrong.
#include "projects/map_file.h"

#include <doctest/doctest.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "projects/safe_file.h"
#include "tests/projects/folder.h"
#include "tests/support/scanned_map.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

const Homography<ProjectorFrame, CameraFrame> kPlane{{1.1, 0.05, -3.0, -0.04, 1.2, 2.5, 1e-4, -2e-4, 1.0}};

DenseMap someMap() {
    DenseMap map = sampledMap(kPlane, {37, 23}, {41, 31}, 1.7);
    std::vector<std::uint8_t> sure(map.confidence.pixels().begin(), map.confidence.pixels().end());
    for (std::size_t i = 0; i < sure.size(); ++i)
        sure[i] = static_cast<std::uint8_t>(i * 7);
    map.confidence = Image<std::uint8_t>(map.confidence.size(), 1, std::move(sure));
    return map;
}

const MapFacts kFacts{
    {"taken", "2026-02-03T04:05:06Z"}, {"device", "Kamera \"Süd\": 1\\2"}, {"rms_px", "0.21"}, {"empty", ""}};

DenseMap with(DenseMap map, float value) {
    std::vector<float> points(map.cameraOfProjector.pixels().begin(), map.cameraOfProjector.pixels().end());
    points[2 * 41 + 8] = value;
    map.cameraOfProjector = Image<float>(map.cameraOfProjector.size(), 2, std::move(points));
    return map;
}

}  // namespace

TEST_CASE("a map is read back exactly as it was written, in each kind of file") {
    const Folder folder;
    for (const char* name : {"map.yml", "map.yaml", "map.yml.gz", "MAP.EXR"}) {
        CAPTURE(name);
        const auto wrote = writeMap(folder / name, someMap(), kFacts);
        REQUIRE_MESSAGE(wrote, wrote.error().what);
        const auto read = readMap(folder / name);
        REQUIRE_MESSAGE(read, read.error().what);
        CHECK(read->map == someMap());
        CHECK(read->facts == kFacts);
    }
    CHECK(contentOf(folder / "map.yml.gz").size() < contentOf(folder / "map.yml").size());
}

TEST_CASE("OpenCV reads a YAML map's matrices under their plain names") {
    const Folder folder;
    for (const char* name : {"map.yml", "map.yml.gz"}) {
        REQUIRE(writeMap(folder / name, someMap()));
        const cv::FileStorage file((folder / name).string(), cv::FileStorage::READ);
        cv::Mat forth, seen, plane;
        file["projector_of_camera"] >> forth;
        file["seen"] >> seen;
        file["projector_from_camera"] >> plane;
        REQUIRE(forth.type() == CV_32FC2);
        CHECK(forth.size() == cv::Size(37, 23));
        CHECK(forth.at<cv::Vec2f>(5, 7)[1] == someMap().projectorOfCamera.at(7, 5, 1));
        CHECK(seen.size() == cv::Size(41, 31));
        CHECK(plane.at<double>(1, 2) == kPlane.m[5]);
    }
}

TEST_CASE("a map's file is refused in one sentence when it is not what it should be") {
    const Folder folder;
    const auto refusal = [](const Result<MapFile>& result) {
        REQUIRE_FALSE(result);
        return result.error().what;
    };
    const auto says = [&](const Result<MapFile>& result, const std::string& words) {
        const std::string sentence = refusal(result);
        CAPTURE(sentence);
        CHECK(sentence.find(words) != std::string::npos);
    };
    says(readMap(folder / "none.yml"), "none.yml");
    says(decodeMap("", "map.yml"), "empty");
    says(decodeMap("hello", "map.yml"), "no scanned map");
    says(decodeMap("%YAML:1.0\n---\nformat: other\n", "map.yml"), "no scanned map");
    says(decodeMap("%YAML:1.0\n---\nformat: illuminatedfocus-map\nversion: 2\n", "map.yml"), "newer version");
    says(decodeMap("%YAML:1.0\n---\nformat: illuminatedfocus-map\nversion: 1\n", "map.yml"), "projector_of_camera");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const MapFormat format : {MapFormat::yaml, MapFormat::gzippedYaml, MapFormat::exr}) {
        const std::string good = encodeMap(someMap(), kFacts, format).value();
        for (std::size_t keep = 1; keep < good.size(); keep += 1 + good.size() / 60)
            CHECK_FALSE(decodeMap(std::string_view(good).substr(0, keep), "map"));
        says(decodeMap(encodeMap(with(someMap(), nan), {}, format).value(), "map"), "pixel (4, 1)");
        says(decodeMap(encodeMap(with(someMap(), 2e6F), {}, format).value(), "map"), "camera_of_projector");
        DenseMap flat = someMap();
        flat.nearest.m = {1, 2, 3, 2, 4, 6, 0, 0, 1};
        says(decodeMap(encodeMap(flat, {}, format).value(), "map"), "turned around");
    }
    DenseMap torn = someMap();
    torn.seen = Image<std::uint8_t>({40, 31}, 1, std::vector<std::uint8_t>(40 * 31, 255));
    says(decodeMap(encodeMap(torn, {}, MapFormat::yaml).value(), "map"), "seen has 40 x 31");
}

TEST_CASE("a map needs a name that says how, and facts that can be kept") {
    const Folder folder;
    CHECK(writeMap(folder / "map.tif", someMap()).error().what.find(".yml") != std::string::npos);
    CHECK_FALSE(writeMap(folder / "map.yml", someMap(), {{"two words", "x"}}));
    CHECK_FALSE(writeMap(folder / "map.yml", someMap(), {{"long", std::string(1001, 'x')}}));
    CHECK_FALSE(fs::exists(folder / "map.yml"));
}

TEST_CASE("a map that cannot be written leaves the old one") {
    const Folder folder;
    REQUIRE(writeMap(folder / "map.exr", someMap(), {{"take", "1"}}));
    for (int step = 1; step < 20; ++step) {
        const FailAt fault(step, Failing::powerFails);
        const auto wrote = writeMap(folder / "map.exr", someMap(), {{"take", "2"}});
        if (!fault.reached()) break;
        CHECK_FALSE(wrote);
        const auto read = readMap(folder / "map.exr");
        REQUIRE(read);
        const bool whole = read->facts.at("take") == "1" || read->facts.at("take") == "2";
        CHECK(whole);
    }
}
