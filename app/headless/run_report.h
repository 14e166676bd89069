// The report of a headless run, as JSON: what was planned, what was played and what was received.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/headless/own_core.h"
#include "app/headless/prepare.h"
#include "app/headless/received_light.h"

namespace ilf::app {

/// What the emulated rig received of a program, beside what was intended.
struct Outcome {
    ReceivedSweep sweep;
    devices::LightComparison light;
    Quantisation quantisation;
    std::array<LensDeviation, 2> lenses;  ///< left, right
};
Outcome outcomeOf(ReceivedSweep sweep, const Program& program, const Rig& rig);
/// No pixel differs, and nothing came in that would hurt a projector.
bool asIntended(const Outcome& outcome);
/// One line.
std::string verdict(const Outcome& outcome);
/// "Light is steady white and the lenses rest.", or what is not so.
std::string inWords(const Ended& ended);

/// What holds for every rig. `seconds` were asked for.
nlohmann::json runReport(const Prepared& project, const std::string& file, double seconds, const Played& played);
void addOutcome(nlohmann::json& report, const Outcome& outcome);
void addMishap(nlohmann::json& report, const Mishap& mishap, const ReceivedSweep& sweep, const Ended& ended);

}  // namespace ilf::app
