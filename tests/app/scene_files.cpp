// Files in the emulated scene: where they stand, what is refused, and a scan of a small glTF against its truth.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "app/emulated_scenes.h"
#include "core/registration/triangulate.h"
#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/emulated_camera.h"
#include "projects/depth_file.h"
#include "tests/projects/folder.h"

namespace {

using namespace ilf;
using namespace ilf::devices;

constexpr Size kRaster{512, 384};

/// Boxes without undersides as a glTF beside its buffer: x right, y up, z to the viewer, metres.
class Boxes {
public:
    void add(std::array<float, 3> least, std::array<float, 3> most) {
        const float x[] = {least[0], most[0]}, y[] = {least[1], most[1]}, z[] = {least[2], most[2]};
        const auto corner = [&](int i, int j, int k) { return std::array{x[i], y[j], z[k]}; };
        face(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
        face(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
        face(corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0));
        face(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
        face(corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1));
    }
    std::filesystem::path write(const Folder& folder, const std::string& name) const {
        const std::size_t points = 4 * positions_.size(), bytes = points + 2 * indices_.size();
        std::string buffer(bytes, '\0');
        std::memcpy(buffer.data(), positions_.data(), points);
        std::memcpy(buffer.data() + points, indices_.data(), bytes - points);
        folder.put(name + ".bin", buffer);
        float least[3] = {1e9F, 1e9F, 1e9F}, most[3] = {-1e9F, -1e9F, -1e9F};
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            least[i % 3] = std::min(least[i % 3], positions_[i]);
            most[i % 3] = std::max(most[i % 3], positions_[i]);
        }
        const auto n = [](auto v) { return std::to_string(v); };
        const auto three = [&](const float* v) { return "[" + n(v[0]) + "," + n(v[1]) + "," + n(v[2]) + "]"; };
        return folder.put(
            name + ".gltf",
            R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "buffers": [{"uri": ")" +
                name + R"(.bin", "byteLength": )" + n(bytes) + R"(}],
                "bufferViews": [{"buffer": 0, "byteLength": )" +
                n(points) + R"(}, {"buffer": 0, "byteOffset": )" + n(points) + R"(, "byteLength": )" +
                n(bytes - points) + R"(}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": )" +
                n(positions_.size() / 3) + R"(, "type": "VEC3", "min": )" + three(least) + R"(, "max": )" +
                three(most) + R"(}, {"bufferView": 1, "componentType": 5123, "count": )" + n(indices_.size()) +
                R"(, "type": "SCALAR"}]})");
    }

private:
    void face(std::array<float, 3> a, std::array<float, 3> b, std::array<float, 3> c, std::array<float, 3> d) {
        const auto first = static_cast<std::uint16_t>(positions_.size() / 3);
        for (const auto& p : {a, b, c, d})
            positions_.insert(positions_.end(), p.begin(), p.end());
        for (const int i : {0, 1, 2, 0, 2, 3})
            indices_.push_back(static_cast<std::uint16_t>(first + i));
    }
    std::vector<float> positions_;
    std::vector<std::uint16_t> indices_;
};

/// Three steps down towards the viewer, beside each other a slab; 31 cm across. Sixty-fourths of a metre, which floats
/// and six decimals both hold exactly.
Boxes stairs() {
    constexpr float k = 1.0F / 64.0F;
    Boxes boxes;
    boxes.add({-10 * k, 0, -8 * k}, {3 * k, 6 * k, -3 * k});
    boxes.add({-10 * k, 0, -3 * k}, {3 * k, 4 * k, 3 * k});
    boxes.add({-10 * k, 0, 3 * k}, {3 * k, 2 * k, 8 * k});
    boxes.add({5 * k, 0, -8 * k}, {10 * k, k, 8 * k});
    return boxes;
}

SceneWish wishOf(const std::string& words) {
    const auto wish = sceneWishFrom(words);
    REQUIRE_MESSAGE(wish, (wish ? std::string() : wish.error().what));
    return *wish;
}

scene::Stage stageOf(const std::string& words) {
    app::readEmulatedScenes();
    auto stage = wishedStage(wishOf(words), kRaster);
    REQUIRE_MESSAGE(stage, (stage ? std::string() : stage.error().what));
    return *std::move(stage);
}

std::string refusal(const std::string& words) {
    app::readEmulatedScenes();
    const auto stage = wishedStage(wishOf(words), kRaster);
    return stage ? "none" : stage.error().what;
}

/// What the camera sees at a point of the world.
scene::Truth truthAt(const scene::SceneView& view, const scene::Vec3& world) {
    const auto at = view.stage().camera.rasterOf(view.stage().cameraAt.fromWorld(world));
    REQUIRE(at);
    const auto truth = view.truth((*at)[0], (*at)[1]);
    REQUIRE(truth);
    return *truth;
}

Pinhole pinholeOf(const scene::SceneLens& lens) {
    return {lens.size, lens.focalX, lens.focalY, lens.centreX, lens.centreY, lens.bend};
}

Pose<CameraSpace, ModelSpace> poseOf(const scene::Placed& at) {
    Pose<ModelSpace, CameraSpace> pose;
    pose.rotation = {at.right.x, at.down.x,  at.ahead.x, at.right.y, at.down.y,
                     at.ahead.y, at.right.z, at.down.z,  at.ahead.z};
    pose.translation = {at.at.x, at.at.y, at.at.z};
    return pose.inverted();
}

/// What a calibration would find.
ProcamCalibration calibrationOf(const scene::Stage& stage) {
    ProcamCalibration c;
    c.camera = pinholeOf(stage.camera);
    c.projector = pinholeOf(stage.projector);
    const auto camera = poseOf(stage.cameraAt), projector = poseOf(stage.projectorAt);
    Pose<ProjectorSpace, ModelSpace> projectorFromModel;
    projectorFromModel.rotation = projector.rotation;
    projectorFromModel.translation = projector.translation;
    c.projectorFromCamera = projectorFromModel * camera.inverted();
    return c;
}

DecodedScan scanOf(const scene::LightTransport& transport) {
    Scan scan{kRaster, grayCodePatterns(kRaster), {}};
    std::vector<float> lux;
    scene::SensorSettings sensor;
    for (const Pattern& pattern : scan.patterns) {
        const Image<std::uint8_t> shown = patternPicture(pattern, kRaster);
        std::vector<float> light;
        for (const std::uint8_t v : shown.pixels())
            light.push_back(v > 0 ? 1.0F : 0.0F);
        transport.shine(light, 15.0, lux);
        ++sensor.seed;
        const Image<std::uint8_t> rgb = scene::exposed(transport, lux, sensor);
        std::vector<std::uint8_t> green;
        for (std::size_t i = 1; i < rgb.pixels().size(); i += 3)
            green.push_back(rgb.pixels()[i]);
        scan.pictures.emplace_back(rgb.size(), 1, std::move(green));
    }
    auto decoded = decodedScan(scan);
    REQUIRE_MESSAGE(decoded, (decoded ? std::string() : decoded.error().what));
    return *std::move(decoded);
}

void checkScan(const scene::LightTransport& transport, double least) {
    const DecodedScan decoded = scanOf(transport);
    const Size size = decoded.confidence.size();
    const auto depth = triangulated(decoded, calibrationOf(transport.stage()));
    REQUIRE_MESSAGE(depth, (depth ? std::string() : depth.error().what));
    double squares = 0.0;
    int near = 0, far = 0, deep = 0, wrong = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            if (decoded.confidence.at(x, y) == 0) continue;
            const auto truth = transport.truth(x + 0.5, y + 0.5);
            const double off = truth ? std::hypot(decoded.projectorOfCamera.at(x, y, 0) - truth->projector[0],
                                                  decoded.projectorOfCamera.at(x, y, 1) - truth->projector[1])
                                     : 1e9;
            if (off > 2.0) {
                ++far;
                continue;
            }
            squares += off * off;
            ++near;
            const double z = static_cast<double>(depth->depth.metres.at(x, y));
            if (z == 0.0) continue;
            ++deep;
            wrong += std::abs(z - truth->depth_m) > 0.005 * truth->depth_m ? 1 : 0;
        }
    }
    MESSAGE(near << " of " << size.width * size.height << " pixels, rms " << std::sqrt(squares / near) << " px, " << far
                 << " farther than 2 px; depth: " << wrong << " of " << deep << " off by more than 0.5 %");
    CHECK(near > least * size.width * size.height);
    CHECK(std::sqrt(squares / near) < 0.2);
    CHECK(far < 0.02 * near);
    CHECK(deep > 0.9 * near);
    CHECK(wrong < 0.05 * deep);
}

}  // namespace

TEST_CASE("scene files: words say which, with commas in quotes, and give themselves back") {
    CHECK(wishOf("scene=a b.glb,board=2").scene == "a b.glb");
    CHECK(wishOf("binning=2,scene=\"a, b.glb\",scale=0.5,hand").scene == "a, b.glb");
    for (const char* words : {"scene=x.exr", "scene=\"a, b.glb\",scale=0.25,board=3,hand", "scene=/a=b.glb,seed=3"}) {
        const SceneWish wish = wishOf(words);
        CHECK(wishOf(wordsOf(wish)) == wish);
    }
    for (const char* words : {"scene=", "scene=\"\"", "scene=\"a", "scene=a\"b", "scale=0", "scale=-1", "scale=x"}) {
        INFO(std::string(words));
        CHECK_FALSE(sceneWishFrom(words));
    }
}

TEST_CASE("scene files: a glTF stands on the desk as its author meant it") {
    const Folder folder;
    Boxes boxes;  // 12 cm high at the back left as the viewer sees it, 6 cm at the front right; made off its origin
    boxes.add({3.0F, 5.0F, 1.0F}, {3.125F, 5.125F, 1.125F});
    boxes.add({3.25F, 5.0F, 1.25F}, {3.375F, 5.0625F, 1.375F});
    const auto file = boxes.write(folder, "two").string();
    const scene::SceneView view(stageOf("scene=" + file));
    CHECK(truthAt(view, {-0.125, 0.125, 0.125}).world.z == doctest::Approx(0.125).epsilon(1e-5));
    CHECK(truthAt(view, {0.125, -0.125, 0.0625}).world.z == doctest::Approx(0.0625).epsilon(1e-5));
    CHECK(std::abs(truthAt(view, {0.12, 0.12, 0.0}).world.z) < 0.003);  // the desk
    const scene::SceneView half(stageOf("scale=0.5,scene=" + file));
    CHECK(truthAt(half, {-0.0625, 0.0625, 0.0625}).world.z == doctest::Approx(0.0625).epsilon(1e-5));
    // With a board there is the board alone.
    CHECK(stageOf("board=2,scene=" + file).things.triangles.size() == stageOf("board=2").things.triangles.size());
}

TEST_CASE("scene files: a scan of a small glTF gives its map and its depth") {
    const Folder folder;
    const auto file = stairs().write(folder, "stairs").string();
    checkScan(scene::LightTransport(stageOf("binning=4,scene=" + file)), 0.7);
}

TEST_CASE("scene files: depth is where its camera saw it, and a scan finds it there") {
    const Folder folder;
    // A wall that recedes to the right, with a hole; half the emulated camera's resolution.
    const Size size{640, 512};
    std::vector<float> metres;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            metres.push_back(x < 20 ? 0.0F : 1.05F + 0.2F * (static_cast<float>(x) + 0.5F) / 640.0F);
    MeasuredDepth measured;
    measured.metres = Image<float>(size, 1, metres);
    const auto file = folder / "wall, tilted.exr";
    REQUIRE(projects::writeDepth(file, measured));
    const scene::LightTransport transport(stageOf("binning=4,scene=\"" + file.string() + "\""));
    for (const int x : {20, 100, 200, 310}) {
        const auto truth = transport.truth(x + 0.5, 130.5);
        REQUIRE(truth);
        CHECK(truth->depth_m == doctest::Approx(1.05 + 0.2 * (x + 0.5) / 320.0).epsilon(1e-4));
    }
    CHECK_FALSE(transport.truth(4.5, 130.5));
    checkScan(transport, 0.6);
}

TEST_CASE("scene files: what cannot be shown is refused in a sentence that helps") {
    const Folder folder;
    CHECK(refusal("scene=" + (folder / "none.glb").string()).find("none.glb") != std::string::npos);
    Boxes house;
    house.add({0, 0, 0}, {12, 8, 10});
    const auto file = house.write(folder, "house").string();
    CHECK(refusal("scene=" + file).find("12 m wide and 8 m high") != std::string::npos);
    CHECK(refusal("scene=" + file).find("scale=0.0") != std::string::npos);
    CHECK(refusal("scale=0.02,scene=" + file) == "none");
    CHECK(refusal("scale=0.001,scene=" + file).find("large") != std::string::npos);
    folder.put("words.exr", "no picture");
    CHECK(refusal("scene=" + (folder / "words.exr").string()).find("words.exr") != std::string::npos);
    MeasuredDepth far;
    far.metres = Image<float>({64, 48}, 1, std::vector<float>(64 * 48, 7.0F));
    REQUIRE(projects::writeDepth(folder / "far.pfm", far));
    CHECK(refusal("scene=" + (folder / "far.pfm").string()).find("7 m away") != std::string::npos);
    // A camera is not even opened for it.
    CHECK(!openEmulatedCamera("emulated:scene=" + (folder / "none.glb").string(), folder.path()));
}
