#include "core/document/document.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf {

double focalPixels(int width, double degrees) {
    return 0.5 * width / std::tan(0.5 * degrees * std::numbers::pi / 180.0);
}

double fieldOfView(int width, double focalPixels) {
    return 2.0 * std::atan2(0.5 * width, focalPixels) * 180.0 / std::numbers::pi;
}

Document newDocument(Scene scene) {
    if (!(scene.scale.focalPixels > 0.0)) {
        scene.scale = {focalPixels(std::max(1, scene.size().width), kDefaultFieldOfView), PixelScale::Source::assumed};
    }
    Region background;
    background.id = kBackgroundId;
    background.name = "Background";
    background.look = Look::neutral;
    background.distance = ConstantDistance{2.0_m, {}};
    Document document;
    document.scene = std::move(scene);
    document.background = Box<Region>(std::move(background));
    return document;
}

const Region* findRegion(const Document& document, const RegionId& id) {
    if (document.background && document.background->id == id) return &*document.background;
    const auto found = std::find_if(document.regions.begin(), document.regions.end(),
                                    [&](const Box<Region>& region) { return region->id == id; });
    return found == document.regions.end() ? nullptr : &**found;
}

std::vector<const Region*> activeRegions(const Document& document) {
    const bool anySolo = std::any_of(document.regions.begin(), document.regions.end(),
                                     [](const Box<Region>& region) { return region->visible && region->solo; });
    std::vector<const Region*> active;
    for (const Box<Region>& region : document.regions) {
        if (region->visible && (region->solo || !anySolo)) active.push_back(&*region);
    }
    return active;
}

PixelMap pixelMap(const Document& document) {
    if (document.rig.registration) return document.rig.registration->map;
    const Size camera = document.scene.size();
    const Size projector = document.rig.projector;
    if (camera.width <= 0 || camera.height <= 0) return {};
    const double scale = std::min(static_cast<double>(projector.width) / camera.width,
                                  static_cast<double>(projector.height) / camera.height);
    const double left = 0.5 * (projector.width - scale * camera.width);
    const double top = 0.5 * (projector.height - scale * camera.height);
    return PixelMap(Homography<ProjectorFrame, CameraFrame>{{scale, 0, left, 0, scale, top, 0, 0, 1}});
}

Point<CameraFrame> cameraAxis(const Document& document) {
    const Size size = document.scene.size();
    const Box<ProcamCalibration>& calibration = document.rig.calibration;
    if (calibration && calibration->camera.size == size) return {calibration->camera.cx, calibration->camera.cy};
    const CameraMode& mode = document.scene.camera;
    if (mode.picture == size && mode.sensor.width > 0 && mode.sensor.height > 0 && mode.binning > 0) {
        return {(0.5 * mode.sensor.width - mode.x0) / mode.binning,
                (0.5 * mode.sensor.height - mode.y0) / mode.binning};
    }
    return {0.5 * size.width, 0.5 * size.height};
}

Point<CameraFrame> opticalCentre(const Document& document, Eye eye, Metre distance) {
    const Point<CameraFrame> axis = cameraAxis(document);
    const double scale = pixelsPerMetre(document, distance);
    const LensAxis& lens = document.wearer.axis(eye);
    return {axis.x + scale * lens.right.si(), axis.y + scale * lens.down.si()};
}

double pixelsPerMetre(const Document& document, Metre distance) {
    return document.scene.scale.focalPixels / (distance + document.wearer.lensToPupil).si();
}

}  // namespace ilf
