#include "projects/calibration_json.h"

#include "core/registration/calibrate.h"
#include "projects/pinhole_json.h"

namespace ilf::projects {

namespace {
const std::string kUnit = "_px";
}
Json written(const ProcamCalibration& calibration, Json json) {
    json.set("camera", written(calibration.camera, kUnit, json.object("camera")));
    json.set("projector", written(calibration.projector, kUnit, json.object("projector")));
    json.set("projector_from_camera", written(calibration.projectorFromCamera, json.object("projector_from_camera")));
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
    c.camera = pinholeFrom(reader.object("camera"), kUnit);
    c.projector = pinholeFrom(reader.object("projector"), kUnit);
    JsonReader pose = reader.object("projector_from_camera");
    c.projectorFromCamera = poseFrom<ProjectorSpace, CameraSpace>(pose);
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
