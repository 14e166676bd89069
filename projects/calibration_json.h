// What a calibration knows, to JSON and back: for its own file and for a rig's.
#pragma once

#include <string>

#include "core/registration/pinhole.h"
#include "projects/json.h"

namespace ilf::projects {

/// `before` is what the file held: the keys this version does not know are kept.
Json written(const ProcamCalibration& calibration, Json before);

/// What is missing, of the wrong kind or not possible (a focal length of 0, a rotation that is none) is the reader's
/// problem.
ProcamCalibration procamCalibrationFrom(JsonReader reader);

}  // namespace ilf::projects
