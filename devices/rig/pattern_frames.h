// Programs as the LightCrafter stage takes them, packed anew only where they changed.
#pragma once

#include "devices/rig/lightcrafter_stage.h"

namespace ilf::devices {

/// For `LightCrafterRig::packed`: see dlpc350::packed for `depth` and what is refused. It remembers the program before,
/// so it serves one stage.
std::function<Result<PatternFrame>(const Program&)> patternFrames(int depth);

}  // namespace ilf::devices
