// A rig's registration to JSON and back; a scanned map lies in a file of its own beside it.
#pragma once

#include <functional>
#include <string>

#include "core/registration/registration.h"
#include "projects/json.h"

namespace ilf::projects {

/// How a camera's picture was cut out of its sensor.
Json written(const CameraMode& camera, Json before);
CameraMode cameraModeFrom(JsonReader reader);

/// Gives the map of that name, from beside the file that names it.
using MapReader = std::function<Result<Box<DenseMap>>(const std::string& name)>;

/// `mapName`: where its dense map is kept; "" for a homography.
Json written(const Registration& registration, Json before, const std::string& mapName);

/// `plane` is the homography that stands beside it; complains through `reader`. The map is read last, and not at all
/// when something else is wrong. Refused: a map that is missing or damaged, or one of another size than is said here.
Result<Box<Registration>> registrationFrom(JsonReader reader, const Homography<ProjectorFrame, CameraFrame>& plane,
                                           const MapReader& maps);

}  // namespace ilf::projects
