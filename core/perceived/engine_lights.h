// At which powers of the lens a scene is lit, and how each surface looks at each of them.
#pragma once

#include <array>
#include <vector>

#include "core/perceived/attention.h"
#include "core/perceived/exposures.h"

namespace ilf::view {

/// Light of one level (or the room's) at one power.
struct PowerLight {
    int level = 0;  ///< Exposure::kAmbient: falls on everything
    Dioptre power;
    double weight = 1.0;
    bool operator==(const PowerLight&) const = default;
};

/// How the lens's power is spread while a level is lit.
struct PowerSpread {
    int level = 0;
    struct Sample {
        double power = 0.0, weight = 0.0;  ///< dioptres; of the picture's brightness
    };
    std::vector<Sample> samples;
    Dioptre mean;
    double weight = 0.0;
};
/// Of all levels with light, and of ambient light.
std::vector<PowerSpread> powerSpreads(const Plan& plan);

/// A spread as the few powers that tell from it: those within `limit` (rms) are one, at their mean; within twice that
/// two, placed so that mean, spread and skew are kept (Gauss's rule for them); farther ones are divided.
std::vector<PowerLight> powerLights(const PowerSpread& spread, Dioptre limit);

/// Of red, green and blue; all alike unless colours are kept apart.
using Looks = std::array<Appearance, 3>;

/// The eye's refraction in the rig's three primaries against the light it is focused with; all 0 when not asked for.
std::array<Dioptre, 3> colourShifts(const Plan& plan, const ViewRequest& request);

}  // namespace ilf::view
