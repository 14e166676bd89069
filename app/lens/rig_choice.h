// What every command that plans may be told of rig and lens.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/lens/lens_planner.h"

namespace ilf::app {

struct RigChoice {
    std::string rig = {};  ///< simulated, emulated or a rig's file, instead of the document's; empty: the document's
    std::optional<int> bits = {};  ///< of a slot's picture, with as many slots as the projector then shows
    std::string waves = {};        ///< how waves are chosen, instead of the rig's; empty: the rig's
    std::string file = {};         ///< calibration, instead of the rig's
    std::string simulated = {};    ///< the lens that is simulated: a preset or ideal; empty: the usual one
};

/// The rig with what was typed in place of its own.
Result<Rig> withOptions(Rig rig, const RigChoice& choice);
/// Refuses a lens that the chosen rig cannot have: an ideal one on emulated cables.
Result<devices::SimulatedLens> simulatedLens(const RigChoice& choice);
/// What a core that plays on this choice is started with.
Result<std::vector<std::string>> coreArguments(const RigChoice& choice);
/// Document with its rig replaced, and the plan for it.
Result<Plan> plannedFor(Document& document, const RigChoice& choice);

/// "the emulated rig", "the simulated devices", "the rig of FILE": where something plays.
std::string inWords(const RigChoice& choice);

}  // namespace ilf::app
