#include "projects/registration_json.h"

#include <cmath>
#include <utility>
#include <vector>

#include "projects/file_tree.h"

namespace ilf::projects {
namespace {

const std::vector<std::string> kMethods{"typed", "corners", "point-pairs", "chessboard", "scan"};
constexpr int kMostPixels = 1 << 16;

Json written(Size size, Json json) {
    json.set("width_px", size.width);
    json.set("height_px", size.height);
    return json;
}

/// 0 x 0 where it is not said.
Size sizeFrom(JsonReader& reader, const char* key) {
    if (!reader.has(key)) return {};
    JsonReader json = reader.object(key);
    const Size size{json.whole("width_px"), json.whole("height_px")};
    const bool possible =
        size.width >= 0 && size.height >= 0 && size.width <= kMostPixels && size.height <= kMostPixels;
    if (!possible) reader.complain(key, "must be a size in pixels");
    return size;
}

double residual(JsonReader& reader, const char* key) {
    const double value = reader.number(key, 0.0);
    if (!(std::isfinite(value) && value >= 0.0)) reader.complain(key, "must be 0 or more");
    return value;
}

}  // namespace

Json written(const CameraMode& camera, Json json) {
    json.set("device", camera.device);
    json.set("sensor", written(camera.sensor, json.object("sensor")));
    json.set("x0_px", camera.x0);
    json.set("y0_px", camera.y0);
    json.set("binning", camera.binning);
    json.set("picture", written(camera.picture, json.object("picture")));
    return json;
}

CameraMode cameraModeFrom(JsonReader reader) {
    CameraMode camera;
    camera.device = reader.word("device", "");
    camera.sensor = sizeFrom(reader, "sensor");
    camera.x0 = reader.has("x0_px") ? reader.whole("x0_px") : 0;
    camera.y0 = reader.has("y0_px") ? reader.whole("y0_px") : 0;
    camera.binning = reader.has("binning") ? reader.whole("binning") : 1;
    if (camera.x0 < 0 || camera.x0 > kMostPixels) reader.complain("x0_px", "must lie on the sensor");
    if (camera.y0 < 0 || camera.y0 > kMostPixels) reader.complain("y0_px", "must lie on the sensor");
    if (camera.binning < 1 || camera.binning > 64) reader.complain("binning", "must be 1 to 64");
    camera.picture = sizeFrom(reader, "picture");
    return camera;
}

Json written(const Registration& registration, Json json, const std::string& mapName) {
    json.set("method", kMethods[static_cast<std::size_t>(registration.method)]);
    json.set("rms_px", registration.rms_px);
    json.set("worst_px", registration.worst_px);
    json.set("points", registration.points);
    json.set("taken", registration.taken);
    json.set("projector_name", registration.projectorName);
    json.set("provenance", registration.provenance);
    json.set("projector", written(registration.projector, json.object("projector")));
    json.set("camera", written(registration.camera, json.object("camera")));
    if (mapName.empty()) {
        json.erase("map");
    } else {
        json.set("map", mapName);
    }
    return json;
}

Result<Box<Registration>> registrationFrom(JsonReader reader, const Homography<ProjectorFrame, CameraFrame>& plane,
                                           const MapReader& maps) {
    Registration registration;
    registration.method = static_cast<Registration::Method>(reader.choice("method", kMethods));
    registration.rms_px = residual(reader, "rms_px");
    registration.worst_px = residual(reader, "worst_px");
    registration.points = reader.has("points") ? reader.whole("points") : 0;
    if (registration.points < 0) reader.complain("points", "must be 0 or more");
    registration.taken = reader.word("taken", "");
    registration.projectorName = reader.word("projector_name", "");
    registration.provenance = reader.word("provenance", "");
    registration.projector = sizeFrom(reader, "projector");
    if (reader.has("camera")) registration.camera = cameraModeFrom(reader.object("camera"));
    registration.map = PixelMap(plane);
    const std::string name = reader.word("map", "");
    if (!name.empty() && !staysInside(name)) reader.complain("map", "must name a file beside this one");
    if (reader.problem()) return tl::unexpected(*reader.problem());
    if (name.empty()) return Box<Registration>(std::move(registration));

    const auto map = maps(name);
    if (!map) {
        return fail(map.error().fault, map.error().what + " It is the map of the rig's registration: put it back, or "
                                                          "register again.");
    }
    const Size picture = registration.camera.picture;
    const auto differs = [](Size said, Size is) { return said != Size{} && said != is; };
    if (differs(picture, (*map)->camera())) reader.complain("map", "must have the camera's picture's size");
    if (differs(registration.projector, (*map)->projector())) reader.complain("map", "must have the projector's size");
    if (reader.problem()) return tl::unexpected(*reader.problem());
    registration.map = PixelMap(*map);
    return Box<Registration>(std::move(registration));
}

}  // namespace ilf::projects
