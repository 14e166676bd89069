// Where the camera's axis meets the picture.
#include "tests/core/compile/received.h"
#include "tests/support/law.h"

using namespace ilf;

TEST_CASE("camera axis: the picture's middle, until a calibration for pictures of this size knows better") {
    Document document = newDocument(blankScene({640, 420}));
    CHECK(cameraAxis(document) == Point<CameraFrame>{320.0, 210.0});
    ProcamCalibration calibration;
    calibration.camera = plainPinhole({640, 420}, 700.0);
    calibration.camera.cx = 331.5;
    calibration.camera.cy = 204.25;
    document.rig.calibration = Box<ProcamCalibration>(calibration);
    CHECK(cameraAxis(document) == Point<CameraFrame>{331.5, 204.25});
    calibration.camera.size = {1280, 840};
    document.rig.calibration = Box<ProcamCalibration>(calibration);
    CHECK(cameraAxis(document) == Point<CameraFrame>{320.0, 210.0});
}
