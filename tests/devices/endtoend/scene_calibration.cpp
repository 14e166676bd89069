// From pictures that the emulated camera takes of the emulated projector's patterns to a calibration and to depth,
// against the truth of the scene, whose code shares nothing with what is tested.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/registration/calibrate.h"
#include "core/registration/triangulate.h"
#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/sensor.h"

namespace {

using namespace ilf;
using namespace ilf::devices;

constexpr Size kRaster{1024, 768};
constexpr double kAmbientLux = 15.0;

struct Taken {
    DecodedScan decoded;
    Image<std::uint8_t> white;
};

/// A scan of the stage by its own camera, with the sensor's noise.
Taken taken(const scene::LightTransport& transport, std::uint64_t seed) {
    Scan scan;
    scan.projector = kRaster;
    scan.patterns = grayCodePatterns(kRaster);
    std::vector<float> lux;
    scene::SensorSettings sensor;
    for (const Pattern& pattern : scan.patterns) {
        const Image<std::uint8_t> picture = patternPicture(pattern, kRaster);
        std::vector<float> light(picture.pixels().size());
        std::ranges::transform(picture.pixels(), light.begin(), [](std::uint8_t v) { return v > 0 ? 1.0f : 0.0f; });
        transport.shine(light, kAmbientLux, lux);
        sensor.seed = ++seed;
        const Image<std::uint8_t> rgb = scene::exposed(transport, lux, sensor);
        std::vector<std::uint8_t> grey(rgb.pixels().size() / 3);
        for (std::size_t i = 0; i < grey.size(); ++i) {
            const std::uint8_t* p = &rgb.pixels()[3 * i];
            grey[i] = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2] + 2) / 4);
        }
        scan.pictures.emplace_back(rgb.size(), 1, std::move(grey));
    }
    auto decoded = decodedScan(scan);
    REQUIRE_MESSAGE(decoded, decoded.error().what);
    return {*std::move(decoded), scan.pictures[0]};
}

scene::Stage stageOf(int pose) {
    scene::Stage stage = scene::builtInStage(kRaster, pose);
    stage.camera = scene::readOut(stage.camera, 0, 0, stage.camera.size, 2);  // a quarter of the pixels, of the time
    return stage;
}

/// The worst of four numbers as a share of the focal length.
double off(const Pinhole& found, const scene::SceneLens& truth) {
    return std::max(std::abs(found.fx - truth.focalX) / truth.focalX, std::abs(found.fy - truth.focalY) / truth.focalY);
}

}  // namespace

TEST_CASE(
    "scene to calibration: five poses of the emulated board give both lenses to 0.3 %, and depth to 0.5 % at 1 m") {
    std::vector<BoardView> views;
    const Board board{9, 6, Metre::fromSi(scene::kBoardSquare_m)};
    for (const int pose : {2, 3, 4, 5, 7}) {
        const scene::LightTransport transport(stageOf(pose));
        const Taken scan = taken(transport, 1000 * static_cast<std::uint64_t>(pose));
        const std::string name = "pose " + std::to_string(pose);
        auto view = boardView(scan.white, scan.decoded, board, name);
        REQUIRE_MESSAGE(view, view.error().what);
        views.push_back(*std::move(view));
    }
    const auto found = calibrated(views, board);
    REQUIRE_MESSAGE(found, found.error().what);
    const scene::Stage truth = stageOf(0);
    const ProcamCalibration& c = found->calibration;
    const auto& back = c.projectorFromCamera.inverted().translation;
    const scene::Vec3 baseline = truth.cameraAt.fromWorld(truth.projectorAt.at);
    const double baselineOff =
        std::hypot(back[0] - baseline.x, back[1] - baseline.y, back[2] - baseline.z) / scene::length(baseline);
    MESSAGE("camera f off by " << 100.0 * off(c.camera, truth.camera) << " %, projector f by "
                               << 100.0 * off(c.projector, truth.projector) << " %, centre by "
                               << c.camera.cx - truth.camera.centreX << ", " << c.camera.cy - truth.camera.centreY
                               << " and " << c.projector.cx - truth.projector.centreX << ", "
                               << c.projector.cy - truth.projector.centreY << " px; baseline by " << 100.0 * baselineOff
                               << " %; residuals " << c.cameraRms_px << ", " << c.projectorRms_px << " px; +-"
                               << found->camera.fx << ", " << found->projector.fx);
    CHECK(off(c.camera, truth.camera) < 0.003);
    CHECK(off(c.projector, truth.projector) < 0.003);
    CHECK(baselineOff < 0.01);
    CHECK(std::ranges::all_of(found->poses, &PoseFit::used));

    const scene::LightTransport desk(stageOf(0));
    const Taken scan = taken(desk, 77);
    const auto depth = triangulated(scan.decoded, c);
    REQUIRE_MESSAGE(depth, depth.error().what);
    std::vector<double> shares, sigmas;
    for (int y = 0; y < depth->depth.metres.height(); y += 3) {
        for (int x = 0; x < depth->depth.metres.width(); x += 3) {
            const double z = static_cast<double>(depth->depth.metres.at(x, y));
            if (z == 0.0) continue;
            const auto there = desk.truth(x + 0.5, y + 0.5);
            if (!there) continue;
            shares.push_back(std::abs(z - there->depth_m) / there->depth_m);
            sigmas.push_back(std::abs(z - there->depth_m) / static_cast<double>(depth->depth.sigma.at(x, y)));
        }
    }
    REQUIRE(shares.size() > 10000);
    std::ranges::sort(shares), std::ranges::sort(sigmas);
    const auto quantile = [](const std::vector<double>& v, double q) {
        return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
    };
    double sum = 0.0;
    for (const double share : shares)
        sum += share * share;
    MESSAGE(shares.size() << " depths: median error " << 100.0 * quantile(shares, 0.5) << " %, 95 of 100 within "
                          << 100.0 * quantile(shares, 0.95) << " %, rms "
                          << 100.0 * std::sqrt(sum / static_cast<double>(shares.size())) << " %; in sigmas: median "
                          << quantile(sigmas, 0.5) << ", 95 within " << quantile(sigmas, 0.95) << "; miss "
                          << depth->missRms_px << " px; " << depth->missed << " missed of "
                          << depth->measured + depth->missed);
    CHECK(quantile(shares, 0.95) < 0.005);
    CHECK(quantile(sigmas, 0.95) < 3.0);
}
