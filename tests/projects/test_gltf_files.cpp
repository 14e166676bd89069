// Every file of the glTF collection: what it holds as glTF-Transform measured it, or a refusal where glTF-Validator
// errs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/solid/extent.h"
#include "projects/gltf_file.h"
#include "tests/projects/folder.h"
#include "tests/support/test_data.h"

using namespace ilf;
using nlohmann::json;
using projects::readGltf;

namespace {

/// glTF-Validator reports errors, or cannot read the file at all.
bool invalid(const json& entry) { return !entry.contains("errors") || entry["errors"].get<int>() > 0; }

json truth(const std::filesystem::path& folder) { return json::parse(contentOf(folder / "GROUND_TRUTH.json")); }

void checkBox(const json& scene, const Solid& solid) {
    const auto extent = extentOf(solid);
    REQUIRE(extent);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(static_cast<double>(extent->least[i]) - scene["bboxMin"][i].get<double>()) <= 1e-5);
        CHECK(std::abs(static_cast<double>(extent->most[i]) - scene["bboxMax"][i].get<double>()) <= 1e-5);
    }
}

}  // namespace

TEST_CASE("Boxes and triangles of all valid models are those of their decoded vertices") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    int models = 0;
    for (const json& entry : truth(*folder)) {
        const bool drawn = entry.contains("scene") && entry["scene"].contains("bboxMin");
        if (invalid(entry) || !drawn || !entry["scene"]["bboxMin"][0].is_number()) continue;
        const std::string file = entry["file"];
        CAPTURE(file);
        const auto scene = readGltf(*folder / file);
        REQUIRE_MESSAGE(scene, scene.error().what);
        CHECK(triangleCount(*scene->solid) == entry["scene"]["drawnTriangles"].get<std::size_t>());
        checkBox(entry["scene"], *scene->solid);
        ++models;
    }
    CHECK(models == 53);
}

TEST_CASE("Every file that glTF-Validator calls invalid is refused in one sentence that names it") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    int refused = 0;
    for (const json& entry : truth(*folder)) {
        if (!invalid(entry)) continue;
        const std::string file = entry["file"];
        CAPTURE(file);
        const auto scene = readGltf(*folder / file);
        REQUIRE_FALSE(scene);
        CHECK(scene.error().fault == Fault::badFile);
        CHECK(scene.error().what.find(std::filesystem::path(file).filename().string()) != std::string::npos);
        ++refused;
    }
    CHECK(refused == 68);
}

TEST_CASE("What tinygltf accepts although it is invalid is refused") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    const json list = json::parse(contentOf(*folder / "ACCEPTED_BUT_INVALID.json"));
    CHECK(list.size() == 20);
    for (const json& file : list) {
        CAPTURE(file);
        CHECK_FALSE(readGltf(*folder / file.get<std::string>()));
    }
}

TEST_CASE("Valid files are read, but for those that say nothing of bytes or kinds they draw") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    std::set<std::string> refused;
    for (const json& entry : truth(*folder)) {
        if (!invalid(entry) && !readGltf(*folder / entry["file"].get<std::string>()))
            refused.insert(entry["file"].get<std::string>());
    }
    CHECK(refused == std::set<std::string>{"validator/accessor/unknown_type.gltf", "validator/root/named_objects.gltf",
                                           "validator/root/unused_objects.gltf"});
}

TEST_CASE("The same cube in four ways, quantised, Draco and meshopt, is the same cube") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    for (const char* file : {"khronos/Box/glTF/Box.gltf", "khronos/Box/glTF-Binary/Box.glb",
                             "khronos/Box/glTF-Embedded/Box.gltf", "khronos/Box/glTF-Draco/Box.gltf",
                             "compressed/BoxDraco.gltf", "compressed/BoxMeshopt.glb", "compressed/BoxMeshopt.gltf"}) {
        CAPTURE(file);
        const auto scene = readGltf(*folder / file);
        REQUIRE(scene);
        REQUIRE(scene->solid->meshes.size() == 1);
        const Mesh& mesh = *scene->solid->meshes[0];
        REQUIRE(mesh.normals.size() == mesh.positions.size());
        for (const auto& triangle : mesh.triangles) {
            for (std::size_t axis = 0; axis < 3; ++axis) {  // the side of the cube that its normals say
                const float n = mesh.normals[triangle[0]][axis];
                if (std::abs(n) < 0.9F) continue;
                for (const std::uint32_t corner : triangle)
                    CHECK(mesh.positions[corner][axis] == doctest::Approx(0.5F * n).epsilon(0.02));
            }
        }
    }
}

TEST_CASE("Triangles face outwards in mirrored copies, too") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    const auto scene = readGltf(*folder / "khronos/NegativeScaleTest/glTF/NegativeScaleTest.gltf");
    REQUIRE(scene);
    std::size_t along = 0, against = 0;
    for (const Box<Mesh>& mesh : scene->solid->meshes) {
        for (const auto& t : mesh->triangles) {
            const auto &a = mesh->positions[t[0]], &b = mesh->positions[t[1]], &c = mesh->positions[t[2]];
            const auto& n = mesh->normals[t[0]];
            const std::array<float, 3> u{b[0] - a[0], b[1] - a[1], b[2] - a[2]},
                v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
            const float facing = n[0] * (u[1] * v[2] - u[2] * v[1]) + n[1] * (u[2] * v[0] - u[0] * v[2]) +
                                 n[2] * (u[0] * v[1] - u[1] * v[0]);
            (facing >= 0.0F ? along : against) += 1;
        }
    }
    CHECK(along > 0);
    CHECK(static_cast<double>(against) <= 0.001 * static_cast<double>(along));
}

TEST_CASE("Names with spaces, percent signs and other scripts lead to their files") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    for (const char* file :
         {"khronos/Box With Spaces/glTF/Box With Spaces.gltf", "khronos/Unicode❤♻Test/glTF/Unicode❤♻Test.gltf",
          "tinygltf_regress/CubeImageUriSpaces/CubeImageUriMultipleSpaces.gltf"}) {
        CAPTURE(file);
        const auto scene = readGltf(*folder / file);
        REQUIRE(scene);
        CHECK(scene->problems.empty());
        CHECK(std::any_of(scene->solid->materials.begin(), scene->solid->materials.end(),
                          [](const Box<Material>& m) { return !m->texture.empty(); }));
    }
}

TEST_CASE("Files cut off anywhere are refused or read, and nothing worse") {
    const auto folder = testData("01_gltf");
    if (!folder) return;
    const Folder cut;
    for (const char* file :
         {"khronos/Box/glTF-Binary/Box.glb", "compressed/BoxMeshopt.glb", "khronos/Box/glTF-Embedded/Box.gltf",
          "khronos/SimpleSparseAccessor/glTF-Embedded/"
          "SimpleSparseAccessor.gltf"}) {
        const std::string whole = contentOf(*folder / file);
        for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 150)
            CHECK_FALSE(readGltf(cut.put("cut.glb", std::string_view(whole).substr(0, length))));
    }
    // Data beside the scene, cut and with bytes changed: Draco and meshopt find out themselves.
    for (const auto& [scene, data] :
         {std::pair("BoxDraco.gltf", "0.bin"), std::pair("DracoSparseMesh.gltf", "DracoSparseMesh.bin"),
          std::pair("BoxMeshopt.gltf", "BoxMeshopt.bin")}) {
        cut.put(scene, contentOf(*folder / "compressed" / scene));
        const std::string whole = contentOf(*folder / "compressed" / data);
        REQUIRE(!whole.empty());
        for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 100) {
            cut.put(data, std::string_view(whole).substr(0, at));
            CHECK_FALSE(readGltf(cut / scene));
            for (const char change : {'\xFF', '\x01', '\x80'}) {
                std::string changed = whole;
                changed[at] = static_cast<char>(changed[at] ^ change);
                cut.put(data, changed);
                const auto read = readGltf(cut / scene);
                CHECK((read || !read.error().what.empty()));
            }
        }
    }
}
