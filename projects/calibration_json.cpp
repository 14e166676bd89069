#include "projects/calibration_json.h"

#include <algorithm>

#include "core/registration/calibrate.h"

namespace ilf::projects {
namespace {

Json written(const Pinhole& pinhole, Json json) {
    json.set("width_px", pinhole.size.width);
    json.set("height_px", pinhole.size.height);
    json.set("fx_px", pinhole.fx);
    json.set("fy_px", pinhole.fy);
    json.set("cx_px", pinhole.cx);
    json.set("cy_px", pinhole.cy);
    json.set("distortion", std::vector<double>(pinhole.distortion.begin(), pinhole.distortion.end()));
    return json;
}

Pinhole pinholeFrom(JsonReader reader) {
    Pinhole pinhole;
    pinhole.size = {reader.whole("width_px"), reader.whole("height_px")};
    pinhole.fx = reader.number("fx_px"), pinhole.fy = reader.number("fy_px");
    pinhole.cx = reader.number("cx_px"), pinhole.cy = reader.number("cy_px");
    std::ranges::copy(reader.numbers("distortion", 5), pinhole.distortion.begin());
    return pinhole;
}

}  // namespace

Json written(const ProcamCalibration& calibration, Json json) {
    json.set("camera", written(calibration.camera, json.object("camera")));
    json.set("projector", written(calibration.projector, json.object("projector")));
    Json pose = json.object("projector_from_camera");
    const auto& [rotation, translation] = calibration.projectorFromCamera;
    pose.set("rotation", std::vector<double>(rotation.begin(), rotation.end()));
    pose.set("translation_m", std::vector<double>(translation.begin(), translation.end()));
    json.set("projector_from_camera", pose);
    json.set("camera_rms_px", calibration.cameraRms_px);
    json.set("projector_rms_px", calibration.projectorRms_px);
    json.set("poses", calibration.poses);
    json.set("scale", calibration.scale);
    json.set("taken", calibration.taken);
    json.set("provenance", calibration.provenance);
    return json;
}

ProcamCalibration procamCalibrationFrom(JsonReader reader) {
    ProcamCalibration c;
    c.camera = pinholeFrom(reader.object("camera"));
    c.projector = pinholeFrom(reader.object("projector"));
    JsonReader pose = reader.object("projector_from_camera");
    std::ranges::copy(pose.numbers("rotation", 9), c.projectorFromCamera.rotation.begin());
    std::ranges::copy(pose.numbers("translation_m", 3), c.projectorFromCamera.translation.begin());
    c.cameraRms_px = reader.number("camera_rms_px");
    c.projectorRms_px = reader.number("projector_rms_px");
    c.poses = reader.whole("poses");
    c.scale = reader.word("scale");
    c.taken = reader.word("taken", "");
    c.provenance = reader.word("provenance");
    if (!reader.problem()) {
        if (const auto good = checked(c); !good)
            reader.complain("camera", "does not belong here: " + good.error().what);
    }
    return c;
}

}  // namespace ilf::projects
