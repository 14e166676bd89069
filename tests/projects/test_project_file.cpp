#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "projects/file_tree.h"
#include "projects/project_file.h"
#include "projects/wearer_rig.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_document.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::projects;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Json jsonAt(const fs::path& file) { return Json::parse(contentOf(file)); }

/// The sentence with which a project is refused after one file of a good one was changed.
std::string refusal(const std::string& file, const std::string& content) {
    Folder folder;
    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    if (content.empty()) {
        fs::remove(folder / ("p.ilfd/" + file));
    } else {
        folder.put("p.ilfd/" + file, content);
    }
    const auto opened = openProject(folder / "p.ilfd");
    REQUIRE_FALSE(opened);
    CHECK(contains(opened.error().what, file));
    return opened.error().what;
}

/// The same after `change` of its project.json.
std::string refusalOf(const std::function<void(Json&)>& change) {
    Folder folder;
    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    Json json = jsonAt(folder / "p.ilfd/project.json");
    change(json);
    folder.put("p.ilfd/project.json", json.dump());
    const auto opened = openProject(folder / "p.ilfd");
    REQUIRE_FALSE(opened);
    return opened.error().what;
}

/// As it was before scenes kept their camera's mode.
Document withoutMode(Document document) {
    document.scene.camera = {};
    return document;
}

}  // namespace

TEST_CASE("project: what is saved opens as the same document, as a folder and zipped") {
    Folder folder;
    for (const char* name : {"full.ilfd", "full.ilf"}) {
        const auto saved = saveProject(folder / name, fullDocument(), {});
        REQUIRE_MESSAGE(saved, saved.error().what);
        const auto opened = openProject(folder / name);
        REQUIRE_MESSAGE(opened, opened.error().what);
        CHECK(opened->document == fullDocument());
    }
    CHECK(fs::is_directory(folder / "full.ilfd"));
    CHECK(fs::is_regular_file(folder / "full.ilf"));
    CHECK(openProject(folder / "full.ilfd/project.json")->document == fullDocument());
    CHECK(openProject((folder / "full.ilfd").string() + "/")->document == fullDocument());

    int round = 0;
    law("any document survives", [&] {
        const Document document = randomDocument();
        ++round;
        const fs::path path = folder / (std::to_string(round) + (round % 2 == 0 ? ".ilfd" : ".ilf"));
        const auto saved = saveProject(path, document, {});
        RC_ASSERT(saved.has_value());
        const auto opened = openProject(path);
        if (!opened) RC_FAIL(opened.error().what);
        RC_ASSERT(opened->document == document);
        // Saving what was opened changes no byte.
        const fs::path again = folder / ("again-" + path.filename().string());
        RC_ASSERT(saveProject(again, opened->document, opened->extras).has_value());
        RC_ASSERT(openProject(again)->document == document);
        if (path.extension() == ".ilfd") {
            RC_ASSERT(contentOf(path / "project.json") == contentOf(again / "project.json"));
        }
    });
}

TEST_CASE(
    "project: measured depth, the wearer's place and what regions follow are kept, and distances follow from them") {
    Folder folder;
    for (const bool withSigma : {true, false}) {
        const Document document = measuredDocument({96, 70}, withSigma);
        for (const char* name : {"measured.ilfd", "measured.ilf"}) {
            const auto saved = saveProject(folder / name, document, {});
            REQUIRE_MESSAGE(saved, saved.error().what);
            const auto opened = openProject(folder / name);
            REQUIRE_MESSAGE(opened, opened.error().what);
            CHECK(opened->document == document);
        }
        // Whole steps stay the picture they were; what has an uncertainty needs more than that.
        CHECK(
            fs::exists(folder / (withSigma ? "measured.ilfd/measured-depth.exr" : "measured.ilfd/measured-depth.png")));
        CHECK_FALSE(fs::exists(folder / "measured.ilfd/depth.png"));
        // Saved again without a change it is the same bytes.
        const auto opened = openProject(folder / "measured.ilfd");
        const auto again = saveProject(folder / "again.ilfd", opened->document, opened->extras);
        REQUIRE(again);
        CHECK(contentOf(folder / "again.ilfd/project.json") == contentOf(folder / "measured.ilfd/project.json"));
    }
    // Distances that are no whole steps, and not made from anything, are kept as they are.
    Document moved = fullDocument();
    std::vector<float> metres(96 * 70, 1.0F / 3.0F);
    metres[7] = 0.0F;
    moved.scene.depth = Box<DepthMap>(DepthMap{Image<float>({96, 70}, 1, std::move(metres)), {}, {}});
    REQUIRE(saveProject(folder / "moved.ilfd", moved, {}));
    CHECK(openProject(folder / "moved.ilfd")->document == moved);
}

TEST_CASE("project: what is wrong with measured depth, the wearer's place or what is followed is named") {
    const auto refused = [](const std::function<void(Json&)>& change) {
        Folder folder;
        REQUIRE(saveProject(folder / "p.ilfd", measuredDocument(), {}));
        Json json = jsonAt(folder / "p.ilfd/project.json");
        change(json);
        folder.put("p.ilfd/project.json", json.dump());
        const auto opened = openProject(folder / "p.ilfd");
        return opened ? std::string() : opened.error().what;
    };
    CHECK(contains(refused([](Json& j) { j["scene"]["viewer"]["rotation"][0] = 3.0; }), "wearer's place must be"));
    CHECK(contains(refused([](Json& j) { j["scene"]["viewer"]["translation_m"] = 3.0; }), "viewer.translation_m"));
    CHECK(
        contains(refused([](Json& j) { j["scene"]["viewer"]["translation_m"][2] = -5.0; }), "in front of the wearer"));
    CHECK(contains(refused([](Json& j) { j["scene"]["measured_depth"]["file"] = "gone.exr"; }), "gone.exr"));
    CHECK(contains(refused([](Json& j) { j["scene"]["measured_depth"]["camera_px"]["fx"] = -1.0; }), "focal lengths"));
    CHECK(contains(refused([](Json& j) { j["regions"][0]["follow"]["id"] = -1; }), "number of a marker must be"));
    CHECK(contains(refused([](Json& j) { j["regions"][0]["follow"]["target"] = "cat"; }), "follow.target"));
    CHECK(
        contains(refused([](Json& j) { j["regions"][2]["follow"]["address"] = "pose"; }), "pose stream starts with /"));
}

TEST_CASE("project: a project of version 2 is loaded forever") {
    const auto opened = openProject(fs::path(ILF_SOURCE_DIR) / "tests/projects/data/version-2.ilfd");
    REQUIRE_MESSAGE(opened, opened.error().what);
    CHECK(opened->document == withoutMode(measuredDocument()));
}

TEST_CASE("project: a project of version 1 is loaded forever") {
    const auto opened = openProject(fs::path(ILF_SOURCE_DIR) / "tests/projects/data/version-1.ilfd");
    REQUIRE_MESSAGE(opened, opened.error().what);
    CHECK(opened->document == withoutMode(fullDocument()));
}

TEST_CASE("project: keys and files that are not known stay, at every level") {
    Folder folder;
    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    Json json = jsonAt(folder / "p.ilfd/project.json");
    json["zebra"] = 1;
    json["scene"]["zebra"] = 2;
    json["scene"]["depth"]["zebra"] = 3;
    json["regions"][0]["zebra"] = {{"deep", "text"}};
    json["regions"][1]["distance"]["zebra"] = 4;
    json["regions"][1]["distance"]["anchors"][2]["zebra"] = 5;
    json["background"]["zebra"] = 6;
    json["seam"]["zebra"] = 7;
    folder.put("p.ilfd/project.json", json.dump());
    Json wearer = jsonAt(folder / "p.ilfd/wearer.json");
    wearer["lens_axes"]["left"]["zebra"] = 8;
    folder.put("p.ilfd/wearer.json", wearer.dump());
    folder.put("p.ilfd/notes/read me.txt", "mine");
    folder.put("p.ilfd/.git/HEAD", "ref");

    auto opened = openProject(folder / "p.ilfd");
    REQUIRE(opened);
    // Regions change places: what is unknown belongs to the region, not to the place.
    std::swap(opened->document.regions[0], opened->document.regions[1]);
    const auto extras = saveProject(folder / "p.ilfd", opened->document, opened->extras);
    REQUIRE(extras);
    const Json after = jsonAt(folder / "p.ilfd/project.json");
    CHECK(after["zebra"] == 1);
    CHECK(after["scene"]["zebra"] == 2);
    CHECK(after["scene"]["depth"]["zebra"] == 3);
    CHECK(after["regions"][1]["zebra"]["deep"] == "text");
    CHECK(after["regions"][0]["distance"]["zebra"] == 4);
    CHECK(after["regions"][0]["distance"]["anchors"][2]["zebra"] == 5);
    CHECK(after["background"]["zebra"] == 6);
    CHECK(after["seam"]["zebra"] == 7);
    CHECK(jsonAt(folder / "p.ilfd/wearer.json")["lens_axes"]["left"]["zebra"] == 8);
    CHECK(contentOf(folder / "p.ilfd/notes/read me.txt") == "mine");
    CHECK(contentOf(folder / "p.ilfd/.git/HEAD") == "ref");

    // Elsewhere and zipped, the notes go along, the repository does not; and back out of the archive again.
    const auto zipped = saveProject(folder / "q.ilf", opened->document, *extras);
    REQUIRE(zipped);
    REQUIRE(saveProject(folder / "r.ilfd", opened->document, *zipped));
    CHECK(contentOf(folder / "r.ilfd/notes/read me.txt") == "mine");
    CHECK_FALSE(fs::exists(folder / "r.ilfd/.git"));
    CHECK(jsonAt(folder / "r.ilfd/project.json")["regions"][1]["zebra"]["deep"] == "text");
}

TEST_CASE("project: files of regions that are gone go too, and the picture's file is kept as it was") {
    Folder folder;
    const Picture picture = noisePicture({40, 30}, 3, false);
    const auto bytes = *encodePicture(picture) + "trailing bytes that another encoder would not write";
    const auto file = readPicture(folder.put("photo.png", bytes));
    REQUIRE(file);
    Document document = newDocument({Box<Picture>(file->picture), "photo.png", {}, {}, {}, {}});
    Region region;
    region.id = "gone";
    region.name = "Gone";
    region.mask = speckled({40, 30}, 4);
    document.regions.emplace_back(region);
    const auto first = saveProject(folder / "p.ilfd", document, ProjectExtras().withOriginal(*file));
    REQUIRE(first);
    CHECK(contentOf(folder / "p.ilfd/picture.png") == bytes);
    CHECK(fs::exists(folder / "p.ilfd/masks/gone.png"));
    document.regions.clear();
    REQUIRE(saveProject(folder / "p.ilfd", document, *first));
    CHECK_FALSE(fs::exists(folder / "p.ilfd/masks/gone.png"));
    CHECK(contentOf(folder / "p.ilfd/picture.png") == bytes);
}

TEST_CASE("project: the newest five backups are kept, and open") {
    Folder folder;
    for (const char* name : {"p.ilfd", "p.ilf"}) {
        Document document = fullDocument();
        ProjectExtras extras;
        for (int i = 0; i < 8; ++i) {
            document.name = "Version " + std::to_string(i);
            const auto saved = saveProject(folder / name, document, extras);
            REQUIRE_MESSAGE(saved, saved.error().what);
            extras = *saved;
        }
        const auto backups = backupsOf(folder / name);
        REQUIRE(backups.size() == 5);
        for (std::size_t i = 0; i < 5; ++i) {
            CHECK(openProject(backups[i])->document.name == "Version " + std::to_string(6 - i));
        }
    }
    fs::remove_all(folder / "p.ilfd");
    CHECK(contains(openProject(folder / "p.ilfd").error().what, "Its newest backup is "));
}

TEST_CASE("project: refusals say what, where, and what would help") {
    CHECK(contains(refusal("project.json", "{\n  \"format\": \"illuminatedfocus-project\",\n  oops\n}"),
                   "project.json\" is damaged at line 3, column 3."));
    CHECK(contains(refusal("project.json", "[]"), "must hold one object"));
    CHECK(contains(refusal("project.json", "{\"format\": \"other\"}"), "is not a project of this program"));
    CHECK(contains(refusal("project.json", "{\"a\": 1e999}"), "cannot be read"));
    CHECK(contains(refusal("masks/2f1c6e0a-face.png", ""), "does not exist"));
    CHECK(contains(refusal("masks/2f1c6e0a-face.png", *encodePng(Image<std::uint8_t>({2, 2}, 1, {1, 2, 3, 4}))),
                   "the mask of \"Face\", has 2 x 2 pixels, but the picture has 96 x 70"));
    CHECK(
        contains(refusal("depth.png", *encodePng16(Image<std::uint16_t>({1, 1}, 1, {1}))), "the depth map, has 1 x 1"));
    CHECK(contains(refusal("picture.png", "nonsense"), "not a picture"));
    CHECK(contains(refusal("wearer.json", "{\"format\": \"illuminatedfocus-rig\"}"), "not a wearer file"));
    CHECK(contains(refusal("rig.json", "{"), "damaged at line 1"));

    CHECK(refusalOf([](Json& j) { j["version"] = 3; }) ==
          "This project was written by a newer version (format 3). Update, or ask for it to be saved as format 2.");
    CHECK(contains(refusalOf([](Json& j) { j["version"] = "new"; }), "version must be a number"));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["distance"]["value_m"] = "far"; }),
                   "regions[0].distance.value_m must be a number."));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["look"] = "loud"; }),
                   "regions[0].look must be focus, blur or neutral, but is \"loud\"."));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][2]["id"] = j["regions"][0]["id"]; }), "regions[2].id must be"));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["id"] = "background"; }), "regions[0].id must be"));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["mask"] = "../../../etc/passwd"; }), "outside the project"));
    CHECK(contains(refusalOf([](Json& j) { j["scene"]["picture"] = "/etc/passwd"; }), "outside the project"));
    CHECK(contains(refusalOf([](Json& j) { j["regions"] = 5; }), "regions must be a list of objects."));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][1]["distance"]["anchors"].erase(0); }), "three points"));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["distance"]["value_m"] = -1; }), "\"Face\""));
    CHECK(contains(refusalOf([](Json& j) { j["regions"][0]["strength_D"] = -4; }), "\"Face\""));
    CHECK_FALSE(refusalOf([](Json& j) { j["alpha_D"] = 1e9; }).empty());
    CHECK_FALSE(refusalOf([](Json& j) { j["seam"]["feather_m"] = -1; }).empty());
    CHECK_FALSE(refusalOf([](Json& j) { j["scene"]["focal_px"] = -1; }).empty());
    CHECK_FALSE(refusalOf([](Json& j) { j["scene"]["depth"]["metres_per_unit"] = 0; }).empty());

    Folder folder;
    CHECK(contains(openProject(folder / "none.ilfd").error().what, "does not exist"));
    CHECK(contains(openProject(folder.path()).error().what, "it has no project.json"));
    CHECK(contains(openProject(folder.put("a.ilf", "PK and nothing more")).error().what, "is not a project"));
    CHECK(contains(openProject(folder.put("b.ilf", "")).error().what, "is "));
    CHECK(contains(saveProject(folder / "a.txt", fullDocument(), {}).error().what, "ends in .ilfd"));
    folder.put("holiday.ilfd/photo.jpg", "x");
    CHECK(contains(saveProject(folder / "holiday.ilfd", fullDocument(), {}).error().what, "other things in it"));
    CHECK(contentOf(folder / "holiday.ilfd/photo.jpg") == "x");
}

TEST_CASE("project: an archive whose names lead out of it is refused, one with a folder around the project is opened") {
    Folder folder;
    const auto text = [](const char* s) { return Box<std::string>(s); };
    REQUIRE(writeZip(folder / "slip.ilf", {{"project.json", text("{}")}, {"../outside.txt", text("x")}}));
    CHECK(contains(openProject(folder / "slip.ilf").error().what, "leads out of it"));
    REQUIRE(writeZip(folder / "absolute.ilf", {{"project.json", text("{}")}, {"/etc/x", text("x")}}));
    CHECK(contains(openProject(folder / "absolute.ilf").error().what, "leads out of it"));
    REQUIRE(writeZip(folder / "other.ilf", {{"letter.txt", text("x")}}));
    CHECK(contains(openProject(folder / "other.ilf").error().what, "archive without a project"));

    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    std::vector<TreeFile> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "p.ilfd")) {
        if (entry.is_regular_file()) {
            files.push_back(
                {entry.path().lexically_relative(folder.path()).string(), Box<std::string>(contentOf(entry))});
        }
    }
    REQUIRE(writeZip(folder / "byhand.ilf", files));
    CHECK(openProject(folder / "byhand.ilf")->document == fullDocument());

    // Cut anywhere, an archive is refused and nothing else.
    const std::string whole = contentOf(folder / "byhand.ilf");
    for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 40) {
        CHECK_FALSE(openProject(folder.put("cut.ilf", whole.substr(0, length))));
    }
}

TEST_CASE("wearer and rig: files of their own") {
    Folder folder;
    const Document document = fullDocument();
    REQUIRE(writeWearer(folder / "w.json", document.wearer));
    REQUIRE(writeRig(folder / "r.json", document.rig));
    CHECK(*readWearer(folder / "w.json") == document.wearer);
    CHECK(*readRig(folder / "r.json") == document.rig);

    Json json = jsonAt(folder / "w.json");
    json["glasses"] = "progressive";
    folder.put("w.json", json.dump());
    REQUIRE(writeWearer(folder / "w.json", Wearer{}));
    CHECK(jsonAt(folder / "w.json")["glasses"] == "progressive");
    CHECK(*readWearer(folder / "w.json") == Wearer{});

    json["pupil_m"] = 4.0;  // millimetres typed where metres belong
    CHECK_FALSE(readWearer(folder.put("w.json", json.dump())));
    json["version"] = 3;
    CHECK(contains(readWearer(folder.put("w.json", json.dump())).error().what, "newer version (format 3)"));
    CHECK(contains(readRig(folder / "w.json").error().what, "is not a rig file"));
    CHECK(contains(readRig(folder / "none.json").error().what, "does not exist"));
}

TEST_CASE("rig: its projector's wavelengths are kept, may be missing, and must be those of red, green and blue light") {
    Folder folder;
    Rig rig;
    rig.primaries = {Metre::fromSi(620 / 1e9), Metre::fromSi(527.5 / 1e9), Metre::fromSi(462 / 1e9)};
    REQUIRE(writeRig(folder / "r.json", rig));
    CHECK(*readRig(folder / "r.json") == rig);
    Json json = jsonAt(folder / "r.json");
    CHECK(json["primaries_nm"] == Json({620.0, 527.5, 462.0}));
    rig.primaries = {};
    REQUIRE(writeRig(folder / "r.json", rig));
    CHECK_FALSE(jsonAt(folder / "r.json").contains("primaries_nm"));
    CHECK_FALSE(readRig(folder / "r.json")->primaries);
    CHECK_FALSE(openProject(fs::path(ILF_SOURCE_DIR) / "tests/projects/data/version-1.ilfd")->document.rig.primaries);

    const auto refused = [&](const Json& primaries) {
        json["primaries_nm"] = primaries;
        const auto read = readRig(folder.put("r.json", json.dump()));
        REQUIRE_FALSE_MESSAGE(read, primaries.dump());
        return read.error().what;
    };
    CHECK(contains(refused({790, 530, 460}), "red light must be from 380 to 780 nm, not 790"));
    CHECK(contains(refused({620, 530, 370}), "blue light must be from 380 to 780 nm"));
    CHECK(contains(refused({460, 530, 620}), "must fall from red over green to blue"));
    CHECK(contains(refused({620, 620, 460}), "must fall"));
    CHECK(contains(refused({6.2e-7, 5.3e-7, 4.6e-7}), "380 to 780 nm"));  // metres typed where nanometres belong
    CHECK(contains(refused({620, 530}), "list of 3 numbers"));
    CHECK(contains(refused("RGB"), "list of 3 numbers"));
}
