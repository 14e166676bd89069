// The emulated scene against what can be worked out on paper: where light lands, how much of it, and what hides it.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "core/registration/pinhole.h"
#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/sensor.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;
using namespace ilf::devices::scene;

namespace {

constexpr Size kRaster{256, 192};

/// A white wall two metres wide in the plane z = 0, seen and lit from above by small plain devices.
Stage wall() {
    Stage stage;
    stage.camera = {{160, 120}, 200.0, 200.0, 80.0, 60.0, {}};
    stage.projector = {kRaster, 300.0, 300.0, 128.0, 96.0, {}};
    stage.cameraAt = lookingAt({0.1, -0.6, 0.9}, {0.0, 0.0, 0.0}, 7.0);
    stage.projectorAt = lookingAt({-0.2, -0.5, 1.0}, {0.02, 0.01, 0.0}, -3.0);
    Look white;
    white.colour = {1.0F, 1.0F, 1.0F};
    const int look = stage.things.addLook(white);
    stage.things.addSheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, look);
    stage.bounce = 0.0;
    return stage;
}

std::vector<float> uniform(float value) {
    return std::vector<float>(static_cast<std::size_t>(kRaster.width) * kRaster.height, value);
}

double total(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Where the ray of a device meets the plane z = 0.
Vec3 onWall(const SceneLens& lens, const Placed& at, double x, double y) {
    const Vec3 along = at.turnedToWorld(lens.rayThrough(x, y));
    return at.at - (at.at.z / along.z) * along;
}

}  // namespace

TEST_CASE("a lens sends each raster place back to itself, bent as OpenCV's model says") {
    law("ray and raster", [](int i, int j) {
        const SceneLens lens = i % 2 == 0 ? builtInCamera() : builtInProjector({912, 1140});
        const double x = lens.size.width * (0.5 + 0.5 * std::sin(i)), y = lens.size.height * (0.5 + 0.5 * std::sin(j));
        const Vec3 ray = lens.rayThrough(x, y);
        const auto back = *lens.rasterOf(3.0 * ray);
        const Pinhole same{lens.size, lens.focalX, lens.focalY, lens.centreX, lens.centreY, lens.bend};
        const auto elsewhere = same.pixelOf(ray.x, ray.y);
        return std::hypot(back[0] - x, back[1] - y) < 1e-9 && std::hypot(elsewhere[0] - x, elsewhere[1] - y) < 1e-9;
    });
    CHECK_FALSE(builtInCamera().rasterOf({0, 0, -1}));
}

TEST_CASE("on a plane the truth is the plane's homography, in closed form") {
    const Stage stage = wall();
    const SceneView view(stage);
    law("camera pixel to wall to projector pixel", [&](int i, int j) {
        const double x = 80.0 + 75.0 * std::sin(i), y = 60.0 + 55.0 * std::sin(j);
        const auto truth = view.truth(x, y);
        RC_ASSERT(truth.has_value());
        const Vec3 p = onWall(stage.camera, stage.cameraAt, x, y);
        const Vec3 seen = stage.projectorAt.fromWorld(p);
        RC_ASSERT(std::abs(truth->depth_m - stage.cameraAt.fromWorld(p).z) < 1e-9);
        RC_ASSERT(truth->lit);
        return std::hypot(truth->projector[0] - (300.0 * seen.x / seen.z + 128.0),
                          truth->projector[1] - (300.0 * seen.y / seen.z + 96.0)) < 1e-8;
    });
}

TEST_CASE("light falls off with the cosine and the square of the distance, and a white wall gives all of it back") {
    const Stage stage = wall();
    const LightTransport transport(stage);
    std::vector<float> out;
    transport.shine(uniform(1.0F), 0.0, out);
    for (const auto& [x, y] : {std::pair{80, 60}, {60, 70}, {95, 45}}) {
        const Vec3 p = onWall(stage.camera, stage.cameraAt, x + 0.5, y + 0.5), toLamp = stage.projectorAt.at - p;
        const double r = length(toLamp), expected = stage.projectorLux * (toLamp.z / r) / (r * r);
        CHECK(out[static_cast<std::size_t>(y * 160 + x)] == doctest::Approx(expected).epsilon(2e-3));
    }
    SUBCASE("ambient light adds to it") {
        std::vector<float> more;
        transport.shine(uniform(0.0F), 50.0, more);
        CHECK(more[static_cast<std::size_t>(60 * 160 + 80)] == doctest::Approx(50.0));
    }
}

TEST_CASE("light is linear: what two pictures give is the sum of what each gives") {
    const LightTransport transport(builtInStage({256, 192}));
    std::vector<float> a = uniform(0.0F), b = a, both = a, outA, outB, outBoth;
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = i % 7 == 0 ? 0.5F : 0.0F;
        b[i] = i % 3 == 0 ? 0.25F : 0.1F;
        both[i] = a[i] + b[i];
    }
    transport.shine(a, 0.0, outA);
    transport.shine(b, 0.0, outB);
    transport.shine(both, 0.0, outBoth);
    for (std::size_t i = 0; i < outA.size(); i += 97)
        CHECK(outBoth[i] == doctest::Approx(outA[i] + outB[i]).epsilon(1e-4));
}

TEST_CASE("one lit projector pixel lights its own place and no light is lost") {
    const Stage stage = wall();
    const LightTransport transport(stage);
    std::vector<float> one = uniform(0.0F), out, all;
    one[static_cast<std::size_t>(96 * kRaster.width + 128)] = 1.0F;
    transport.shine(one, 0.0, out);
    transport.shine(uniform(1.0F), 0.0, all);
    double x = 0.0, y = 0.0;
    for (int j = 0; j < 120; ++j) {
        for (int i = 0; i < 160; ++i) {
            const double share = static_cast<double>(out[static_cast<std::size_t>(j * 160 + i)]) / total(out);
            x += share * (i + 0.5);
            y += share * (j + 0.5);
        }
    }
    const Vec3 p = onWall(stage.projector, stage.projectorAt, 128.5, 96.5);
    const auto there = *stage.camera.rasterOf(stage.cameraAt.fromWorld(p));
    CHECK(std::hypot(x - there[0], y - there[1]) < 0.05);
    // Its light in camera pixels is the area it covers there.
    const auto corner = [&](double u, double v) {
        return *stage.camera.rasterOf(stage.cameraAt.fromWorld(onWall(stage.projector, stage.projectorAt, u, v)));
    };
    const auto a = corner(128, 96), b = corner(129, 96), c = corner(128, 97);
    const double area = std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    const auto at = static_cast<std::size_t>(std::floor(there[1])) * 160 + static_cast<std::size_t>(there[0]);
    CHECK(total(out) / static_cast<double>(all[at]) == doctest::Approx(area).epsilon(0.03));
}

TEST_CASE(
    "what stands before the lamp shades what lies behind it, and hides it from the camera where it stands there") {
    Stage stage = wall();
    const Vec3 between = 0.5 * (stage.projectorAt.at + Vec3{0.0, 0.0, 0.0});
    stage.things.addSheet(between + Vec3{-0.05, -0.05, 0.0}, {0.1, 0, 0}, {0, 0.1, 0}, 0);
    const SceneView view(stage);
    const auto seenAt = [&](const Vec3& p) {
        const auto pixel = *stage.camera.rasterOf(stage.cameraAt.fromWorld(p));
        return view.truth(pixel[0], pixel[1]);
    };
    CHECK_FALSE(seenAt({0.0, 0.0, 0.0})->lit);
    CHECK(seenAt({0.2, 0.1, 0.0})->lit);
    CHECK(seenAt(between)->lit);
    CHECK(seenAt(between)->world.z == doctest::Approx(0.5));
}

TEST_CASE("surfaces that face each other throw light at each other, and never more than they get") {
    Stage stage = wall();
    stage.bounce = 1.0;
    stage.things.addSheet({-1, 0.25, 0}, {2, 0, 0}, {0, 0, 1}, 0);  // a second wall, upright
    const LightTransport with(stage);
    stage.bounce = 0.0;
    const LightTransport without(stage);
    std::vector<float> a, b;
    with.shine(uniform(1.0F), 0.0, a);
    without.shine(uniform(1.0F), 0.0, b);
    CHECK(total(a) > 1.01 * total(b));
    CHECK(total(a) < 2.0 * total(b));
}

TEST_CASE("the sensor's noise has the variance its electrons say") {
    Stage stage = wall();
    const LightTransport transport(stage);
    const std::vector<float> flat(160 * 120, 100.0F);
    SensorSettings settings;
    settings.gamma = 1.0;
    settings.fullWell = 2000.0;
    settings.perLuxSecond = 1000.0 / (100.0 * settings.exposure.si());  // half of the range
    const auto picture = exposed(transport, flat, settings);
    double sum = 0.0, squares = 0.0;
    for (const std::uint8_t code : picture.pixels()) {
        sum += code;
        squares += double(code) * code;
    }
    const auto count = static_cast<double>(picture.pixels().size());
    const double mean = sum / count, variance = squares / count - mean * mean;
    const double codes = 255.0 / settings.fullWell;
    CHECK(mean == doctest::Approx(127.5).epsilon(0.005));
    CHECK(variance == doctest::Approx(codes * codes * (1000.0 + 144.0) + 1.0 / 12.0).epsilon(0.05));
    settings.seed = 2;
    CHECK_FALSE(exposed(transport, flat, settings) == picture);
    settings.noisy = false;
    CHECK(exposed(transport, flat, settings).at(3, 3) == 128);
}

TEST_CASE("a part of the sensor and pixels put together see the same places") {
    const SceneLens whole = builtInCamera(), part = readOut(whole, 200, 120, {640, 512}, 2);
    CHECK(part.size == Size{320, 256});
    const Vec3 a = whole.rayThrough(200 + 2 * 77.25, 120 + 2 * 31.5), b = part.rayThrough(77.25, 31.5);
    CHECK(length(a - b) < 1e-12);
}

TEST_CASE("every pose of the board is lit and seen whole") {
    const Stage plain = builtInStage({1024, 768});
    for (int pose = 1; pose <= kBoardPoses; ++pose) {
        CAPTURE(pose);
        const Placed board = boardPose(pose);
        for (int corner = 0; corner < 4; ++corner) {
            const Vec3 p = board.at + (corner % 2) * kBoardAcross * kBoardSquare_m * board.right +
                           (corner / 2) * kBoardDown * kBoardSquare_m * board.down;
            for (const auto& [lens, at] :
                 {std::pair{plain.camera, plain.cameraAt}, {plain.projector, plain.projectorAt}}) {
                const auto raster = lens.rasterOf(at.fromWorld(p));
                REQUIRE(raster.has_value());
                CHECK((*raster)[0] > 0.0);
                CHECK((*raster)[1] > 0.0);
                CHECK((*raster)[0] < lens.size.width);
                CHECK((*raster)[1] < lens.size.height);
            }
            // Seen from its front by both, not too slantingly.
            CHECK(dot(unit(p - plain.cameraAt.at), board.ahead) > 0.6);
            CHECK(dot(unit(p - plain.projectorAt.at), board.ahead) > 0.5);
            CHECK(p.z > 0.0);
        }
    }
}
