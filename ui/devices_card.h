// The devices of the rig, one by one: which it is, how it is, and what would help.
#pragma once

#include <string>
#include <vector>

#include "ui/panel.h"

namespace ilf::ui {

void devicesCard(Panel& p);

/// Asks for another rig; at once in steady light, after the operator's word while something plays.
void wantRig(Panel& p, const std::string& rig);

/// What kind of devices these are, in the operator's words: "simulated", "emulated" (the drivers of real devices over
/// emulated cables) or "hardware".
std::string kindOf(const CoreStatus& core);

/// "well", "unplugged", ...
std::string word(DeviceHealth health);

/// How well the light keeps time, where that is measured.
struct TimingRow {
    const char* label;
    std::string value;
    const char* help;
};
std::vector<TimingRow> timingRows(const CoreStatus& core);

}  // namespace ilf::ui
