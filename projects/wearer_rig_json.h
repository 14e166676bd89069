// Wearer and rig to JSON and back, for their own files and for those inside a project.
#pragma once

#include <string>

#include "core/document/rig.h"
#include "core/document/wearer.h"
#include "projects/json.h"
#include "projects/registration_json.h"

namespace ilf::projects {

/// `before` is what the file held: the keys this version does not know are kept.
Json written(const Wearer& wearer, Json before);
/// `mapName`: the file beside it that keeps the registration's dense map, where it has one.
Json written(const Rig& rig, Json before, const std::string& mapName = "");
Json written(const RigDevices& devices, Json before);

Result<Wearer> wearerFrom(const Json& json, const std::string& file);
/// `maps` is asked for the registration's map, if the rig has one.
Result<Rig> rigFrom(const Json& json, const std::string& file, const MapReader& maps);
/// What is not said is as a rig with unnamed devices has it.
RigDevices rigDevicesFrom(JsonReader reader);

}  // namespace ilf::projects
