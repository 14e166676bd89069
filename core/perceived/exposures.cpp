#include "core/perceived/exposures.h"

#include "core/plan/notes.h"

namespace ilf::view {

double ambientShare(const Plan& plan) {
    const double ambient_lx = plan.input.rig.room.ambient_lx;
    return ambient_lx > 0.0 ? ambient_lx / (ambient_lx + litIlluminance(plan)) : 0.0;
}

std::vector<Exposure> exposures(const Plan& plan) {
    const double ambient = ambientShare(plan);
    const double slot = (1.0 - ambient) / (static_cast<double>(plan.slots.size()) * plan.light);
    std::vector<Exposure> all;
    for (const Slot& one : plan.slots) {
        for (const LevelLight& lit : one.lit)
            all.push_back({lit.level, one.start, one.duration, slot * lit.weight});
    }
    if (ambient > 0.0) all.push_back({Exposure::kAmbient, {}, 1.0 / plan.waveform.rate, ambient});
    return all;
}

}  // namespace ilf::view
