// The current at which a lens comes to rest at a power, from its static calibration.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/document/rig_devices.h"

namespace ilf::app {

/// Between two points on the straight line; refused beyond them. Without points only 0 D is taken to be 0 A. `lens` is
/// what it is called: "left lens".
Result<Ampere> restCurrent(const LensWiring& wiring, Dioptre rest, const std::string& lens);

}  // namespace ilf::app
