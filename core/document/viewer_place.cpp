#include "core/document/viewer_place.h"

#include <cmath>
#include <numbers>

namespace ilf {

namespace {
constexpr double kDegree = std::numbers::pi / 180.0;
}

ViewerPose viewerAt(const ViewerPlace& place, Metre sigma) {
    ViewerPose viewer;
    viewer.sigma = sigma;
    if (place == ViewerPlace{}) return viewer;
    const double st = std::sin(place.turned_deg * kDegree), ct = std::cos(place.turned_deg * kDegree);
    const double sd = std::sin(place.tilted_deg * kDegree), cd = std::cos(place.tilted_deg * kDegree);
    // Columns: the viewer's right, down and forward in the camera's space.
    Pose<CameraSpace, ViewerSpace> cameraFromViewer;
    cameraFromViewer.rotation = {ct, -st * sd, st * cd, 0.0, cd, sd, -st, -ct * sd, ct * cd};
    cameraFromViewer.translation = {place.right.si(), place.down.si(), -place.behind.si()};
    viewer.viewerFromCamera = cameraFromViewer.inverted();
    viewer.source = "typed";
    return viewer;
}

ViewerPlace placeOf(const ViewerPose& viewer) {
    const auto cameraFromViewer = viewer.viewerFromCamera.inverted();
    const auto& r = cameraFromViewer.rotation;
    const auto& t = cameraFromViewer.translation;
    const auto clean = [](double v) { return std::abs(v) < 1e-12 ? 0.0 : v; };
    return {Metre::fromSi(clean(t[0])), Metre::fromSi(clean(t[1])), Metre::fromSi(clean(-t[2])),
            clean(std::atan2(r[2], r[8]) / kDegree), clean(std::atan2(r[5], std::hypot(r[2], r[8])) / kDegree)};
}

}  // namespace ilf
