#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/calibrate.h"
#include "projects/calibration_file.h"
#include "projects/calibration_json.h"
#include "projects/safe_file.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"
#include "tests/support/test_data.h"

namespace {

using namespace ilf;
using namespace ilf::projects;

ProcamCalibration some() {
    ProcamCalibration c;
    c.camera = {{1280, 1024}, 1500.123456789, 1504.0, 652.0, 498.0, {-0.21, 0.14, 6e-4, -4e-4, 0.1}};
    c.projector = {{1024, 768}, 1650.0, 1646.0, 519.0, 742.0, {-0.05, 0.04, 0.0, 0.0, 0.0}};
    const double a = 0.3;
    c.projectorFromCamera.rotation = {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
    c.projectorFromCamera.translation = {-0.25, 0.01, 0.03};
    c.cameraRms_px = 0.12, c.projectorRms_px = 0.31, c.poses = 6;
    c.scale = "board", c.taken = "2026-11-23T04:00:00Z", c.provenance = "measured";
    return c;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("calibration file: what is written is read, to the last bit") {
    const Folder folder;
    REQUIRE(writeCalibration(folder / "c.json", some()));
    const auto back = readCalibration(folder / "c.json");
    REQUIRE_MESSAGE(back, back.error().what);
    CHECK(*back == some());
}

TEST_CASE("calibration file: keys of a later version's hand stay, another file's do not") {
    const Folder folder;
    REQUIRE(writeCalibration(folder / "c.json", some()));
    folder.put("c.json", replaced(contentOf(folder / "c.json"), "\"poses\": 6", "\"poses\": 6,\n  \"room\": \"east\""));
    REQUIRE(writeCalibration(folder / "c.json", some()));
    CHECK(contentOf(folder / "c.json").find("\"room\": \"east\"") != std::string::npos);
    folder.put("c.json", R"({"format": "another", "room": "west"})");
    REQUIRE(writeCalibration(folder / "c.json", some()));
    CHECK(contentOf(folder / "c.json").find("west") == std::string::npos);
}

TEST_CASE("calibration file: what cannot be a calibration is refused with a sentence that names the file") {
    const Folder folder;
    REQUIRE(writeCalibration(folder / "good.json", some()));
    const std::string good = contentOf(folder / "good.json");
    const auto refusal = [&](const std::string& text) {
        folder.put("bad.json", text);
        const auto read = readCalibration(folder / "bad.json");
        return read ? std::string("accepted") : read.error().what;
    };
    CHECK(refusal(good) == "accepted");
    for (const std::string& text :
         {std::string("{"), std::string("{}"), replaced(good, "\"version\": 1", "\"version\": 2"),
          replaced(good, "-calibration", "-rig"), replaced(good, "\"fx_px\": 1500.123456789", "\"fx_px\": 0"),
          replaced(good, "\"fx_px\": 1500.123456789", "\"fx_px\": \"1500\""),
          replaced(good, "\"width_px\": 1280", "\"width_px\": -1"), replaced(good, "\"cy_px\"", "\"cy\""),
          replaced(good, "0.955336489125606", "0.8"), replaced(good, "\"poses\": 6", "\"poses\": -6"),
          replaced(good, "\"camera_rms_px\": 0.12", "\"camera_rms_px\": -0.12")}) {
        const std::string said = refusal(text);
        INFO(said);
        const bool newer = said.find("newer version") != std::string::npos;
        CHECK((newer || said.find("bad.json") != std::string::npos));
    }
    CHECK_FALSE(readCalibration(folder / "absent.json"));
}

TEST_CASE("calibration file: a disk that fails leaves the old one or the new one") {
    auto other = some();
    other.poses = 9;
    for (const auto how : {Failing::fullDisk, Failing::powerFails}) {
        for (int step = 1;; ++step) {
            const Folder folder;
            REQUIRE(writeCalibration(folder / "c.json", some()));
            bool reached = false;
            {
                const FailAt failing(step, how);
                (void)writeCalibration(folder / "c.json", other);
                reached = failing.reached();
            }
            const auto left = readCalibration(folder / "c.json");
            REQUIRE(left);
            CHECK((*left == some() || *left == other));
            if (!reached) break;
        }
    }
}

TEST_CASE("calibration file: OpenCV's of a real rig is read, with half a pixel and millimetres") {
    const auto file = testData("03_procam/kamino410/calibration_result.xml");
    if (!file) return;
    const auto read = importCalibration(*file, {1024, 768});
    REQUIRE_MESSAGE(read, read.error().what);
    CHECK(read->camera.size == Size{1280, 1024});
    CHECK(read->camera.fx == doctest::Approx(3452.3929068729908));
    CHECK(read->camera.cx == doctest::Approx(587.17314727289579 + 0.5));
    CHECK(read->projector.cy == doctest::Approx(1357.8282322407788 + 0.5));
    CHECK(read->projector.distortion[4] == doctest::Approx(1.6984855309227804));
    CHECK(read->projectorFromCamera.translation[1] == doctest::Approx(-0.63045718819563251));
    CHECK(read->projectorFromCamera.rotation[5] == doctest::Approx(0.078740920161649047));
    CHECK(read->cameraRms_px == doctest::Approx(0.85657309970713724));

    const Folder folder;
    const std::string text = contentOf(*file);
    for (const std::string& bad : {std::string("no xml"), replaced(text, "cam_int", "cam_out"),
                                   replaced(text, "<cols>5", "<cols>4"), text.substr(0, text.size() / 2)}) {
        folder.put("bad.xml", bad);
        const auto refused = importCalibration(folder / "bad.xml", {1024, 768});
        REQUIRE_FALSE(refused);
        INFO(refused.error().what);
        CHECK(refused.error().what.find("bad.xml") != std::string::npos);
    }
    CHECK_FALSE(importCalibration(*file, {0, 768}));
}
