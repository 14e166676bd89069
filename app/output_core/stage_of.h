// The stage that plays a rig: simulated, or made of the devices that the rig names.
#pragma once

#include <filesystem>
#include <memory>

#include "app/output_core/played_rig.h"
#include "devices/stage.h"

namespace ilf::app {

/// Opens nothing yet: devices are opened when the stage is first told something. A rig that cannot be played gives a
/// stage that refuses everything with the reason.
std::unique_ptr<devices::Stage> stageOf(const PlayedRig& played, const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::app
