// Scenes made to be wrong in one way, and what is repaired, ignored or moved in sound ones.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/solid/extent.h"
#include "tests/projects/made_gltf.h"

using namespace ilf;
using nlohmann::json;
using projects::readGltf;

namespace {

/// The square, its JSON open to be spoilt.
struct MadeGltf : MadeSquare {
    nlohmann::json json = nlohmann::json::parse(kJson);

    Result<projects::GltfScene> read() const { return readAs(json.dump()); }
    /// The sentence of its refusal, or "" where it is read.
    std::string refusal() const {
        const auto scene = read();
        return scene ? "" : scene.error().what;
    }
};

bool says(const std::string& sentence, const std::string& part) {
    INFO(sentence);
    return sentence.find(part) != std::string::npos;
}

bool anySays(const std::vector<std::string>& sentences, const std::string& part) {
    for (const std::string& sentence : sentences) {
        if (sentence.find(part) != std::string::npos) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("A small sound scene is read as it is") {
    const MadeGltf made;
    const auto scene = made.read();
    REQUIRE_MESSAGE(scene, scene.error().what);
    CHECK(scene->problems.empty());
    REQUIRE(scene->solid->meshes.size() == 1);
    CHECK(scene->solid->meshes[0]->name == "square");
    CHECK(triangleCount(*scene->solid) == 2);
    CHECK(extentOf(*scene->solid) == Extent{{0, 0, 0}, {1, 1, 0}});
}

TEST_CASE("Nodes that form a loop, are shared or shown from within are refused") {
    MadeGltf loop;
    loop.json["nodes"] = json::parse(R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])");
    CHECK(says(loop.refusal(), "loop"));
    MadeGltf own;
    own.json["nodes"] = json::parse(R"([{"mesh": 0, "children": [0]}])");
    CHECK(says(own.refusal(), "loop"));
    MadeGltf shared;
    shared.json["nodes"] = json::parse(R"([{"children": [1]}, {"mesh": 0}, {"children": [1]}])");
    CHECK(says(shared.refusal(), "already"));
    MadeGltf nested;
    nested.json["nodes"] = json::parse(R"([{"mesh": 0}, {"children": [0]}])");
    CHECK(says(nested.refusal(), "no root"));
}

TEST_CASE("References beyond their list are refused, wherever they are") {
    for (const char* pointer :
         {"/accessors/0/bufferView", "/bufferViews/1/buffer", "/meshes/0/primitives/0/attributes/POSITION",
          "/meshes/0/primitives/0/indices", "/meshes/0/primitives/0/material", "/nodes/0/mesh", "/nodes/0/camera",
          "/nodes/0/skin", "/scenes/0/nodes/0", "/scene"}) {
        CAPTURE(pointer);
        for (const json& index : {json(77), json(-1), json(0.5), json("0"), json(1e300)}) {
            MadeGltf made;
            made.json[json::json_pointer(pointer)] = index;
            CHECK_FALSE(made.refusal().empty());
        }
    }
}

TEST_CASE("Indices beyond the vertices are refused with the index") {
    MadeGltf made;
    made.indices[4] = 9;
    CHECK(says(made.refusal(), "vertex 9 of 4"));
    made.indices[4] = 65535;  // the restart of strips, which glTF forbids
    CHECK(says(made.refusal(), "vertex 65535 of 4"));
}

TEST_CASE("Positions that are no numbers are refused, with their element") {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        MadeGltf made;
        made.positions[7] = value;
        CHECK(says(made.refusal(), "no number at element 2"));
    }
    MadeGltf far;
    far.json["nodes"][0]["scale"] = {1e300, 1, 1};
    CHECK(says(far.refusal(), "beyond every number"));
}

TEST_CASE("Accessors that reach beyond their bytes are refused, and counts that no memory holds") {
    MadeGltf made;
    made.json["accessors"][0]["count"] = 5;
    CHECK(says(made.refusal(), "reaches to byte 60"));
    for (const json& count : {json(0), json(-3), json(2000000000), json(1e18)}) {
        MadeGltf huge;
        huge.json["accessors"][0]["count"] = count;
        CHECK_FALSE(huge.refusal().empty());
    }
    MadeGltf zeros;  // an accessor without a view is all zeros: its count costs the file nothing
    zeros.json["accessors"][0] = json::parse(R"({"componentType": 5126, "count": 2000000000, "type": "VEC3"})");
    CHECK(says(zeros.refusal(), "2000000000 elements"));
    MadeGltf longer;
    longer.json["buffers"][0]["byteLength"] = 61;
    CHECK(says(longer.refusal(), "has 60 bytes, where it promises 61"));
}

TEST_CASE("A scene that multiplies its meshes beyond what is read is refused before it is built") {
    MadeGltf made;
    made.json["accessors"][0] = json::parse(R"({"componentType": 5126, "count": 1000000, "type": "VEC3"})");
    made.json["nodes"] = json::array();
    made.json["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 30; ++i) {
        made.json["nodes"].push_back({{"mesh", 0}});
        made.json["scenes"][0]["nodes"].push_back(i);
    }
    CHECK(says(made.refusal(), "million vertices"));
}

TEST_CASE("Files are read beneath the scene's own folder and nowhere else") {
    MadeGltf made;
    made.folder.put("outside.bin", made.bytes());
    const auto inside = made.folder.put("inside/data.bin", made.bytes());
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), std::string("a/../../outside.bin"),
          (made.folder.path() / "outside.bin").string(), std::string("file:///etc/passwd"),
          std::string("http://example.com/data.bin"), std::string("..\\outside.bin"), std::string("")}) {
        CAPTURE(uri);
        made.json["buffers"][0]["uri"] = uri;
        const auto scene = readGltf(made.folder.put("inside/scene.gltf", made.json.dump()));
        REQUIRE_FALSE(scene);
        CHECK(says(scene.error().what, "buffers[0].uri"));
    }
    std::filesystem::create_symlink(made.folder / "outside.bin", made.folder.path() / "inside/link.bin");
    made.json["buffers"][0]["uri"] = "link.bin";
    const auto linked = readGltf(made.folder.put("inside/scene.gltf", made.json.dump()));
    REQUIRE_FALSE(linked);
    CHECK(says(linked.error().what, "leads out"));
    made.json["buffers"][0]["uri"] = "./data.bin";
    CHECK(readGltf(made.folder.put("inside/scene.gltf", made.json.dump())));
    CHECK(inside.filename() == "data.bin");
}

TEST_CASE("What the file claims of its extent is not believed") {
    MadeGltf made;
    made.json["accessors"][0]["min"] = {-100, -100, -100};
    made.json["accessors"][0]["max"] = {100, 100, 100};
    const auto scene = made.read();
    REQUIRE(scene);
    CHECK(extentOf(*scene->solid) == Extent{{0, 0, 0}, {1, 1, 0}});
    CHECK(anySays(scene->problems, "claims"));
}

TEST_CASE("Nodes move, turn and mirror what they show") {
    MadeGltf made;
    made.json["nodes"] = json::parse(R"([{"translation": [1, 2, 3], "children": [1]},
        {"rotation": [0, 0, 0.70710678118654752, 0.70710678118654752], "children": [2]},
        {"scale": [-2, 3, 1], "mesh": 0}])");
    const auto scene = made.read();
    REQUIRE(scene);
    const Mesh& mesh = *scene->solid->meshes[0];
    // (1, 0, 0) is scaled to (-2, 0, 0), turned to (0, -2, 0), moved to (1, 0, 3).
    CHECK(mesh.positions[1][0] == doctest::Approx(1.0));
    CHECK(mesh.positions[1][1] == doctest::Approx(0.0));
    CHECK(mesh.positions[1][2] == doctest::Approx(3.0));
    const auto& t = mesh.triangles[0];
    const auto &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const float area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    CHECK(area == doctest::Approx(6.0));  // still counter-clockwise from +z
}

TEST_CASE("Strips and fans become triangles wound alike, points and lines are not drawn") {
    MadeGltf strip;
    strip.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    strip.indices = {0, 1, 2, 3, 0, 0};
    strip.json["accessors"][1]["count"] = 4;
    strip.json["meshes"][0]["primitives"][0]["mode"] = 5;
    const auto one = strip.read();
    REQUIRE(one);
    CHECK(one->solid->meshes[0]->triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}});

    MadeGltf fan;
    fan.indices = {0, 1, 2, 3, 0, 0};
    fan.json["accessors"][1]["count"] = 4;
    fan.json["meshes"][0]["primitives"][0]["mode"] = 6;
    const auto two = fan.read();
    REQUIRE(two);
    CHECK(two->solid->meshes[0]->triangles == std::vector<std::array<std::uint32_t, 3>>{{1, 2, 0}, {2, 3, 0}});

    MadeGltf points;
    points.json["meshes"][0]["primitives"][0]["mode"] = 0;
    const auto three = points.read();
    REQUIRE(three);
    CHECK(triangleCount(*three->solid) == 0);
    CHECK(extentOf(*three->solid) == Extent{{0, 0, 0}, {1, 1, 0}});
    CHECK(anySays(three->problems, "not drawn"));
}

TEST_CASE("Cameras stand where their nodes are, looking along -z with y up") {
    MadeGltf made;
    made.json["cameras"] = json::parse(R"([{"type": "perspective", "name": "front",
        "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}}])");
    made.json["nodes"] =
        json::parse(R"([{"mesh": 0}, {"camera": 0, "translation": [0.5, 0.5, 2], "scale": [3, 3, 3]}])");
    made.json["scenes"][0]["nodes"] = {0, 1};
    const auto scene = made.read();
    REQUIRE(scene);
    REQUIRE(scene->cameras.size() == 1);
    const auto& camera = scene->cameras[0];
    CHECK(camera.name == "front");
    const auto corner = camera.cameraFromModel({1.0, 1.0, 0.0});  // right of, above and before it
    CHECK(corner.x == doctest::Approx(0.5));
    CHECK(corner.y == doctest::Approx(-0.5));
    CHECK(corner.z == doctest::Approx(2.0));
    const Pinhole pinhole = camera.pinhole({640, 480});
    CHECK(pinhole.fy == doctest::Approx(240.0 / std::tan(0.4)));
    CHECK(pinhole.fx == pinhole.fy);
}

TEST_CASE("JSON that is too deep, not UTF-8, or needs what is unknown is refused") {
    MadeGltf deep;
    json nested = json::object();
    for (int i = 0; i < 200; ++i)
        nested = json{{"a", std::move(nested)}};
    deep.json["extras"] = nested;
    CHECK(says(deep.refusal(), "nested"));
    const Folder folder;
    CHECK_FALSE(readGltf(folder.put("many.gltf", "{\"a\":" + std::string(5'000'000, '['))));
    CHECK_FALSE(readGltf(folder.put("odd.gltf", "{\"asset\":{\"version\":\"\xFF\xFE\"}}")));
    MadeGltf unknown;
    unknown.json["extensionsUsed"] = {"VENDOR_shape"};
    unknown.json["extensionsRequired"] = {"VENDOR_shape"};
    CHECK(says(unknown.refusal(), "VENDOR_shape"));
    CHECK_FALSE(readGltf(folder / "nothing.gltf"));
    CHECK_FALSE(readGltf(folder.path()));
}

TEST_CASE("A texture that is missing or damaged leaves the scene drawable, and is told") {
    MadeGltf made;
    made.json["images"] = json::parse(R"([{"uri": "gone.png"}])");
    made.json["textures"] = json::parse(R"([{"source": 0}])");
    made.json["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    made.json["meshes"][0]["primitives"][0]["material"] = 0;
    auto scene = made.read();
    REQUIRE(scene);
    CHECK(anySays(scene->problems, "gone.png"));
    made.folder.put("gone.png", "\x89PNG\r\n\x1a\nnothing");
    scene = made.read();
    REQUIRE(scene);
    CHECK(anySays(scene->problems, "images[0]"));
    CHECK(scene->solid->materials[0]->texture.empty());
}
