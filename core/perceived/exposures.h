// When light falls on the scene and for how long: what both ways of working out a view integrate over.
#pragma once

#include <vector>

#include "core/plan/plan.h"

namespace ilf::view {

/// Light of one level (or the room's) while the lens runs through Waveform::powerAt(start .. start + duration).
struct Exposure {
    static constexpr int kAmbient = -1;
    int level = 0;  ///< index into Plan::levels and Program::images; kAmbient: falls on everything
    Second start, duration;
    double weight = 1.0;  ///< of the picture's own brightness, where its light is 1
};

/// All of one sweep; weights of the levels that light a region, plus ambient light, add up to 1.
std::vector<Exposure> exposures(const Plan& plan);

/// E_a / (E_a + E_p): the part of a region's light that comes from the room; E_p is the projector's mean illuminance
/// (scheduling 6).
double ambientShare(const Plan& plan);

}  // namespace ilf::view
