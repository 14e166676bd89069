// What every command that plans may be told of the lens.
#pragma once

#include <string>

#include "app/lens/lens_planner.h"

namespace ilf::app {

struct LensChoice {
    std::string waves;      ///< how waves are chosen, instead of the rig's; empty: the rig's
    std::string file;       ///< calibration, instead of the rig's
    std::string simulated;  ///< the lens that is simulated: a preset or ideal; empty: the usual one
};

/// The rig with what was typed in place of its own.
Result<Rig> withOptions(Rig rig, const LensChoice& options);
Result<devices::SimulatedLens> simulatedLens(const LensChoice& options);
/// Document with its rig replaced, and the plan for it.
Result<Plan> plannedFor(Document& document, const LensChoice& options);

}  // namespace ilf::app
