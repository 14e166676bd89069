#include "scanned.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/document/viewer_place.h"
#include "core/document/wearer_distances.h"
#include "core/registration/gray_code.h"
#include "core/registration/map_check.h"
#include "core/registration/triangulate.h"

namespace ilf::samples {
namespace {

constexpr Size kRaster{512, 400};
/// Levels of a camera of 8 bits: what is there without light, what full light adds on white, noise.
constexpr double kDark = 6.0, kWhite = 190.0, kNoise = 1.0;
/// A surface this much behind the one that the projector meets first lies in its shadow, metres.
constexpr double kShadow = 0.006;
constexpr int kAcross = 3;  // samples along each side of a pixel

ProcamCalibration procam(const Scene& scene, Size picture) {
    ProcamCalibration c;
    const double focal = 0.5 * picture.width / std::tan(0.5 * double(scene.camera.across));
    c.camera = plainPinhole(picture, focal);
    // To the right of the camera, a little above, turned to the middle of the desk; it lights all that the camera sees.
    const double focalRaster = 0.72 * kRaster.width, turn = 24.0 * double(kPi) / 180.0;
    const std::array<double, 3> at{0.24, -0.08, -0.04};
    c.projector = {
        kRaster, focalRaster, focalRaster, 0.33 * kRaster.width, 0.42 * kRaster.height, {0.03, -0.02, 0.0, 0.0, 0.0}};
    Pose<ProjectorSpace, CameraSpace> pose;
    pose.rotation = {std::cos(turn), 0, std::sin(turn), 0, 1, 0, -std::sin(turn), 0, std::cos(turn)};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            pose.translation[i] -= pose.rotation[3 * i + k] * at[k];
    c.projectorFromCamera = pose;
    c.cameraRms_px = 0.15;
    c.projectorRms_px = 0.20;
    c.poses = 8;
    c.scale = "board";
    c.taken = "2026-02-03T10:00:00Z";
    c.provenance = "simulated";
    return c;
}

/// Where the light of each sample of the picture comes from, and how much of it comes back.
class Lit {
public:
    Lit(const Rendering& rendering, const ProcamCalibration& calibration)
        : size_{rendering.width, rendering.height}, calibration_(calibration), depth_(rendering.depth),
          nearest_(std::size_t(kRaster.width) * std::size_t(kRaster.height), 1e9) {
        for (int y = 0; y < kAcross * size_.height; ++y)
            for (int x = 0; x < kAcross * size_.width; ++x)
                if (const auto met = meet((x + 0.5) / kAcross, (y + 0.5) / kAcross)) {
                    double& nearest = nearest_[cell(*met)];
                    nearest = std::min(nearest, met->z);
                }
        for (std::size_t i = 0; i < depth_.size(); ++i) {
            // The picture's own brightness stands for how much comes back; type stays dark.
            const std::uint8_t* rgb = rendering.picture.data() + 3 * i;
            const double code = (54.0 * rgb[0] + 183.0 * rgb[1] + 19.0 * rgb[2]) / (256.0 * 255.0);
            albedo_.push_back(0.22 + 0.78 * std::pow(code, 1.5));
        }
    }

    /// Grey, 8 bits.
    Image<std::uint8_t> photographed(const Pattern& pattern, unsigned seed) const {
        const Image<std::uint8_t> shown = patternPicture(pattern, kRaster);
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, kNoise);
        std::vector<std::uint8_t> pixels;
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x) {
                double light = 0.0;
                for (int k = 0; k < kAcross * kAcross; ++k) {
                    const auto met = meet(x + (k % kAcross + 0.5) / kAcross, y + (k / kAcross + 0.5) / kAcross);
                    if (!met || met->z > nearest_[cell(*met)] + kShadow) continue;
                    light += shown.at(int(met->x), int(met->y)) / 255.0;
                }
                const std::size_t i = std::size_t(y) * std::size_t(size_.width) + std::size_t(x);
                const double level = kDark + kWhite * albedo_[i] * light / (kAcross * kAcross) + noise(random);
                pixels.push_back(std::uint8_t(std::clamp(std::lround(level), 0L, 255L)));
            }
        return {size_, 1, std::move(pixels)};
    }

private:
    struct Met {
        double x, y;  // on the raster
        double z;     // from the projector
    };
    std::optional<Met> meet(double x, double y) const {
        const std::size_t i = std::size_t(y) * std::size_t(size_.width) + std::size_t(x);
        const double z = double(depth_[i]) + double(kLensToPupil);
        if (!(depth_[i] > 0.0f)) return std::nullopt;
        const auto slopes = calibration_.camera.slopesOf(x, y);
        const auto p = calibration_.projectorFromCamera(Point3<CameraSpace>{slopes[0] * z, slopes[1] * z, z});
        if (!(p.z > 0.05)) return std::nullopt;
        const auto at = calibration_.projector.pixelOf(p.x / p.z, p.y / p.z);
        if (!(at[0] >= 0.0 && at[1] >= 0.0 && at[0] < kRaster.width && at[1] < kRaster.height)) return std::nullopt;
        return Met{at[0], at[1], p.z};
    }
    static std::size_t cell(const Met& met) {
        return std::size_t(met.y) * std::size_t(kRaster.width) + std::size_t(met.x);
    }

    Size size_;
    const ProcamCalibration& calibration_;
    const std::vector<float>& depth_;
    std::vector<double> nearest_;
    std::vector<double> albedo_;
};

Image<float> rounded(const Image<float>& image, float steps) {
    std::vector<float> out(image.pixels().begin(), image.pixels().end());
    for (float& value : out)
        value = std::round(value * steps) / steps;
    return {image.size(), image.channels(), std::move(out)};
}

DenseMap rounded(DenseMap map) {
    map.projectorOfCamera = rounded(map.projectorOfCamera, 16.0f);
    map.cameraOfProjector = rounded(map.cameraOfProjector, 16.0f);
    return map;
}

Result<MapCheck> checkedOn(const Lit& lit, const DenseMap& map, Pattern::Kind kind, unsigned seed) {
    const Pattern pattern = checkPattern(kind, kRaster);
    return mapCheck(map, pattern, lit.photographed(pattern, seed),
                    lit.photographed({pattern.kind, pattern.bit, true}, seed + 1));
}

}  // namespace

Result<Document> scanned(Document document, const Scene& scene, const Rendering& rendering) {
    const ProcamCalibration calibration = procam(scene, {rendering.width, rendering.height});
    const Lit lit(rendering, calibration);
    Scan scan{kRaster, grayCodePatterns(kRaster), {}};
    for (const Pattern& pattern : scan.patterns)
        scan.pictures.push_back(lit.photographed(pattern, unsigned(scan.pictures.size()) + 1));
    const auto decoded = decodedScan(scan);
    if (!decoded) return tl::unexpected(decoded.error());
    auto map = denseMap(*decoded);
    if (!map) return tl::unexpected(map.error());
    *map = rounded(*std::move(map));
    const auto columns = checkedOn(lit, *map, Pattern::Kind::column, 101);
    if (!columns) return tl::unexpected(columns.error());
    const auto rows = checkedOn(lit, *map, Pattern::Kind::row, 201);
    if (!rows) return tl::unexpected(rows.error());
    auto depth = triangulated(*decoded, calibration);
    if (!depth) return tl::unexpected(depth.error());

    Registration registration;
    registration.map = PixelMap(Box(*std::move(map)));
    registration.camera = {"drawn", {rendering.width, rendering.height}, 0, 0, 1, {rendering.width, rendering.height}};
    registration.projector = kRaster;
    registration.method = Registration::Method::scan;
    registration.rms_px = std::hypot(columns->rms_px, rows->rms_px);
    registration.worst_px = std::max(columns->worst_px, rows->worst_px);
    registration.points = decoded->count[std::size_t(PixelState::decoded)];
    registration.taken = calibration.taken;
    registration.provenance = "simulated";
    document.rig.projector = kRaster;
    document.rig.registration = Box(std::move(registration));
    document.rig.calibration = Box(calibration);

    MeasuredDepth measured = std::move(depth->depth);
    measured.metres = rounded(measured.metres, 8192.0f);
    measured.sigma = rounded(measured.sigma, 16384.0f);
    measured.source = "scan of " + scene.name + " (made by make-samples)";
    measured.provenance = "simulated";
    document.scene.viewer = viewerAt({}, 5.0_mm);
    document.scene.depth = Box(wearerDistances(measured, document.scene.viewer, document.wearer));
    document.scene.measured = Box(std::move(measured));
    return document;
}

}  // namespace ilf::samples
