#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/base/grey.h"
#include "core/document/plane_anchors.h"
#include "core/document/plane_fit.h"
#include "core/document/wearer_distances.h"
#include "core/track/marker.h"

namespace ilf {

namespace {

constexpr double kLeastCorner_px = 0.1;  // what sub-pixel refinement of a sharp corner is good for
constexpr double kFewestPixels = 16.0;   // along a marker's side
constexpr double kSteepest_deg = 80.0;   // of the line of sight against the surface's normal

using Corners = std::vector<cv::Point2f>;  // OpenCV's: a pixel's centre is whole

Result<Corners> cornersOf(const Picture& picture, const SurfaceMarker& marker) {
    const auto found = findMarkers(greyOf(picture), {marker.dictionary, {marker.id}, {}, 1});
    if (!found) return tl::unexpected(found.error());
    const std::string name = "Marker " + std::to_string(marker.id) + " of " + marker.dictionary;
    if (found->empty()) {
        return fail(Fault::notFound, name + " is not in the picture: lay it flat on the surface, all four corners and "
                                            "a white rim visible, and grab again.");
    }
    if (found->size() > 1) {
        return fail(Fault::outOfRange,
                    name + " is in the picture " + std::to_string(found->size()) + " times: leave one.");
    }
    Corners corners;
    for (const Point<CameraFrame>& corner : found->front().corners)
        corners.emplace_back(static_cast<float>(corner.x - 0.5), static_cast<float>(corner.y - 0.5));
    if (std::sqrt(cv::contourArea(corners)) < kFewestPixels) {
        return fail(Fault::outOfRange, name + " is less than 16 px wide in the picture, too little for a slope: print "
                                              "it larger, or move the camera nearer.");
    }
    return corners;
}

/// The surface in the camera's space: every point p on it has normal . p = offset.
struct Surface {
    cv::Vec3d normal, middle;
    double offset = 0.0;
    double rms_px = 0.0, side_px = 0.0;
};

Result<Surface> surfaceOf(const Corners& corners, const Pinhole& camera, Metre side) {
    const auto half = static_cast<float>(0.5 * side.si());
    const std::vector<cv::Point3f> model{{-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
    const cv::Matx33d intrinsics(camera.fx, 0, camera.cx - 0.5, 0, camera.fy, camera.cy - 0.5, 0, 0, 1);
    std::vector<cv::Mat> turns, moves;
    std::vector<double> errors;
    const int poses = cv::solvePnPGeneric(model, corners, intrinsics, camera.distortion, turns, moves, false,
                                          cv::SOLVEPNP_IPPE_SQUARE, cv::noArray(), cv::noArray(), errors);
    if (poses == 0) return fail(Fault::notFound, "No pose fits the marker's corners: lay it flat and grab again.");
    cv::Matx33d turn;
    cv::Rodrigues(turns.front(), turn);  // the one with the smaller residual comes first
    const cv::Vec3d move(moves.front().reshape(1, 3));
    Surface surface;
    surface.normal = {turn(0, 2), turn(1, 2), turn(2, 2)};
    surface.middle = move;
    surface.offset = surface.normal.dot(move);
    surface.rms_px = errors.front();
    surface.side_px = std::sqrt(cv::contourArea(corners));
    const double steepness = std::abs(surface.offset) / cv::norm(move);
    if (!(steepness > std::cos(kSteepest_deg * CV_PI / 180.0))) {
        return fail(Fault::outOfRange, "The surface under the marker is seen edge-on: move the camera above it.");
    }
    return surface;
}

}  // namespace

Pinhole sceneCamera(const Document& document) {
    const Size size = document.scene.size();
    if (document.scene.measured && document.scene.measured->camera.size == size) return document.scene.measured->camera;
    if (document.rig.calibration && document.rig.calibration->camera.size == size) {
        return document.rig.calibration->camera;
    }
    Pinhole plain = plainPinhole(size, document.scene.scale.focalPixels);
    const auto axis = cameraAxis(document);
    plain.cx = axis.x, plain.cy = axis.y;
    return plain;
}

Result<MarkerPlane> markerPlane(const Document& document, const Region& region, const Pinhole& camera,
                                const SurfaceMarker& marker) {
    if (!document.scene.picture) return fail(Fault::notFound, "There is no picture to look for the marker in.");
    if (!isFinite(marker.side) || marker.side < 5.0_mm || marker.side > 2.0_m) {
        return fail(Fault::outOfRange, "The side of the marker's black square must be from 5 to 2000 mm.");
    }
    try {
        const auto corners = cornersOf(*document.scene.picture, marker);
        if (!corners) return tl::unexpected(corners.error());
        const auto surface = surfaceOf(*corners, camera, marker.side);
        if (!surface) return tl::unexpected(surface.error());
        const auto& viewer = document.scene.viewer.viewerFromCamera;
        const double lens = document.wearer.lensToPupil.si();
        const auto distanceAlong = [&](Point<CameraFrame> at) -> std::optional<Metre> {
            const auto [sx, sy] = camera.slopesOf(at.x, at.y);
            const double across = surface->normal.dot({sx, sy, 1.0});
            const double depth = surface->offset / across;
            if (!std::isfinite(depth) || depth <= 0.0) return std::nullopt;
            const double distance = viewer(Point3<CameraSpace>{sx * depth, sy * depth, depth}).z - lens;
            if (distance < kNearestDepth.si() || distance > kFarthestDistance.si()) return std::nullopt;
            return Metre::fromSi(distance);
        };
        MarkerPlane plane;
        plane.rms_px = surface->rms_px;
        const cv::Vec3d& middle = surface->middle;
        const double away = viewer(Point3<CameraSpace>{middle[0], middle[1], middle[2]}).z - lens;
        plane.markerDistance = Metre::fromSi(away);
        const auto cornersThree = [&] {
            std::array<Point<CameraFrame>, 3> three{};
            for (std::size_t i = 0; i < 3; ++i)
                three[i] = {static_cast<double>((*corners)[i].x) + 0.5, static_cast<double>((*corners)[i].y) + 0.5};
            return three;
        };
        const auto placed = [&](const std::array<Point<CameraFrame>, 3>& places) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto distance = distanceAlong(places[i]);
                if (!distance) return false;
                plane.distance.anchors[i] = {places[i], *distance};
            }
            return true;
        };
        if (!placed(planeAnchors(document, region)) && !placed(cornersThree())) {
            return fail(Fault::outOfRange,
                        "The surface under the marker is not in front of the wearer's lens: move the "
                        "wearer, or the marker.");
        }
        double farthest = away;
        for (const DistanceAnchor& anchor : plane.distance.anchors)
            farthest = std::max(farthest, anchor.distance.si());
        const double corner_px = std::max(kLeastCorner_px, surface->rms_px);
        plane.distance.tolerance = Metre::fromSi(2.0 * farthest * corner_px * std::sqrt(2.0) / surface->side_px);
        return plane;
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, std::string("The marker could not be looked for: ") + e.what());
    }
}

}  // namespace ilf
