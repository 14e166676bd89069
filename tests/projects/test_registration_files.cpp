// A rig's registration in files: rig files with a map beside them, projects with it inside, and rigs of old.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "projects/map_file.h"
#include "projects/project_file.h"
#include "projects/wearer_rig.h"
#include "tests/projects/folder.h"
#include "tests/support/scanned_map.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

const Homography<ProjectorFrame, CameraFrame> kPlane{{1.1, 0.05, -3.0, -0.04, 1.2, 2.5, 1e-4, -2e-4, 1.0}};

Box<Registration> scanned(double bend) {
    Registration made = *registered(Box<DenseMap>(sampledMap(kPlane, {37, 23}, {41, 31}, bend)));
    made.camera = {"usb:046d:0825", {74, 46}, 0, 0, 2, {37, 23}};
    made.rms_px = 0.21;
    made.worst_px = 1.75;
    made.points = 801;
    made.taken = "2026-03-01T12:00:00Z";
    made.projectorName = "LightCrafter \"4500\"";
    made.provenance = "emulated";
    return Box<Registration>(std::move(made));
}

Rig rigWith(Box<Registration> registration) {
    Rig rig;
    rig.projector = {41, 31};
    rig.registration = std::move(registration);
    return rig;
}

std::vector<std::string> namesIn(const Folder& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("registration: a rig file brings back all that is known of a homography") {
    const Folder folder;
    Registration pairs = *registered(kPlane);
    pairs.method = Registration::Method::pointPairs;
    pairs.rms_px = 0.6;
    pairs.points = 12;
    pairs.taken = "2026-03-01T12:00:00Z";
    pairs.projector = {41, 31};
    const Rig rig = rigWith(Box<Registration>(pairs));
    REQUIRE(writeRig(folder / "rig.json", rig));
    const auto read = readRig(folder / "rig.json");
    REQUIRE_MESSAGE(read, read.error().what);
    CHECK(*read == rig);
    CHECK(namesIn(folder) == std::vector<std::string>{"rig.json"});
}

TEST_CASE("registration: a scanned map lies beside the rig file, and the one before it goes") {
    const Folder folder;
    const Rig rig = rigWith(scanned(1.5));
    REQUIRE(writeRig(folder / "rig.json", rig));
    CHECK(*readRig(folder / "rig.json") == rig);
    const auto first = namesIn(folder);
    REQUIRE(first.size() == 2);
    REQUIRE(writeRig(folder / "rig.json", rig));
    CHECK(namesIn(folder) == first);

    const Rig again = rigWith(scanned(0.5));
    REQUIRE(writeRig(folder / "rig.json", again));
    CHECK(*readRig(folder / "rig.json") == again);
    CHECK(namesIn(folder).size() == 2);
    CHECK(namesIn(folder) != first);

    REQUIRE(writeRig(folder / "rig.json", rigWith(registered(kPlane))));
    CHECK(namesIn(folder) == std::vector<std::string>{"rig.json"});
}

TEST_CASE("registration: a rig whose map is missing, damaged or another's is refused in words") {
    const Folder folder;
    REQUIRE(writeRig(folder / "rig.json", rigWith(scanned(1.5))));
    const std::string map = namesIn(folder)[0] == "rig.json" ? namesIn(folder)[1] : namesIn(folder)[0];
    const std::string text = contentOf(folder / "rig.json");
    const std::string bytes = contentOf(folder / map);

    std::filesystem::remove(folder / map);
    CHECK(contains(readRig(folder / "rig.json").error().what, "register again"));
    folder.put(map, bytes.substr(0, bytes.size() / 2));
    CHECK(contains(readRig(folder / "rig.json").error().what, map));
    REQUIRE(writeMap(folder / map, sampledMap(kPlane, {20, 20}, {41, 31})));
    CHECK(contains(readRig(folder / "rig.json").error().what, "picture's size"));

    folder.put(map, bytes);
    CHECK(readRig(folder / "rig.json"));
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        REQUIRE(contains(changed, from));
        changed.replace(changed.find(from), from.size(), to);
        folder.put("rig.json", changed);
        return readRig(folder / "rig.json");
    };
    CHECK_FALSE(with(map, "../elsewhere.exr"));
    CHECK(contains(with("\"scan\"", "\"guess\"").error().what, "method"));
    CHECK(contains(with("\"binning\": 2", "\"binning\": 0").error().what, "binning"));
    CHECK(contains(with("\"rms_px\": 0.21", "\"rms_px\": -1").error().what, "rms_px"));
}

TEST_CASE("registration: a rig of version 1 knows its homography and no more") {
    const Folder folder;
    REQUIRE(writeRig(folder / "new.json", rigWith(registered(kPlane))));
    std::string text = contentOf(folder / "new.json");
    const auto at = text.find("\"version\": 2");
    REQUIRE(at != std::string::npos);
    text.replace(at, 12, "\"version\": 1");
    const auto from = text.find("\"registration\""), to = text.find("\"provenance\": \"simulated\"");
    REQUIRE(from < to);
    text.erase(from, to - from);
    folder.put("old.json", text);
    const auto read = readRig(folder / "old.json");
    REQUIRE_MESSAGE(read, read.error().what);
    CHECK(*read == rigWith(registered(kPlane)));
}

TEST_CASE("registration: camera and projector as pinholes come back with the rig") {
    const Folder folder;
    ProcamCalibration calibration;
    calibration.camera = {{1280, 1024}, 1500, 1501, 640, 512, {0.1, -0.2, 0.001, 0.002, 0.03}};
    calibration.projector = {{1024, 768}, 1700, 1702, 512, 700, {}};
    calibration.projectorFromCamera.translation = {0.2, -0.01, 0.05};
    calibration.cameraRms_px = 0.2;
    calibration.projectorRms_px = 0.3;
    calibration.poses = 7;
    calibration.scale = "board";
    calibration.taken = "2026-03-01T12:00:00Z";
    calibration.provenance = "emulated";
    Rig rig;
    rig.calibration = Box<ProcamCalibration>(calibration);
    REQUIRE(writeRig(folder / "rig.json", rig));
    const auto read = readRig(folder / "rig.json");
    REQUIRE_MESSAGE(read, read.error().what);
    CHECK(*read == rig);
}

TEST_CASE("registration: a project keeps its scanned map inside, as a folder and zipped, and lets go of it") {
    const Folder folder;
    Scene scene;
    scene.picture = Box<Picture>(Picture({37, 23}, 3, std::vector<std::uint16_t>(37 * 23 * 3, 0x4040)));
    Document document = newDocument(scene);
    document.rig = rigWith(scanned(1.5));
    for (const char* name : {"a.ilfd", "b.ilf"}) {
        CAPTURE(name);
        const auto saved = saveProject(folder / name, document, {});
        REQUIRE_MESSAGE(saved, saved.error().what);
        const auto opened = openProject(folder / name);
        REQUIRE_MESSAGE(opened, opened.error().what);
        CHECK(opened->document.rig == document.rig);
        // Saved again elsewhere: it goes along.
        REQUIRE(saveProject(folder / (std::string("again-") + name), opened->document, opened->extras));
        CHECK(openProject(folder / (std::string("again-") + name))->document.rig == document.rig);
    }
    CHECK(std::filesystem::exists(folder / "a.ilfd/rig-map.exr"));
    const auto opened = openProject(folder / "a.ilfd").value();
    Document plain = opened.document;
    plain.rig.registration = registered(kPlane);
    REQUIRE(saveProject(folder / "a.ilfd", plain, opened.extras));
    CHECK_FALSE(std::filesystem::exists(folder / "a.ilfd/rig-map.exr"));
    CHECK(openProject(folder / "a.ilfd")->document.rig == plain.rig);

    std::filesystem::remove(folder / "again-a.ilfd/rig-map.exr");
    CHECK(contains(openProject(folder / "again-a.ilfd").error().what, "register again"));
}
