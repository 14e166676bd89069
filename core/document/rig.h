// The machine a project plays on: projector raster, rates, delays, lens limits and where its light lands.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "core/base/geometry.h"
#include "core/base/quantity.h"

namespace ilf {

/// A rig is a file of its own: one room is the same for every project.
struct Rig {
    std::string name = "Simulated rig";
    Size projector{1024, 768};
    Hertz sweepRate = 60.0_Hz;
    Hertz slotRate = 960.0_Hz;        ///< an integer multiple of the sweep rate, or light would flicker below it
    Second projectorDelay = 0.46_ms;  ///< trigger to light (paper, section 4)
    Dioptre lensMin = -10.0_D;
    Dioptre lensMax = 10.0_D;
    /// Where a camera pixel lands on the projector's raster; absent: the picture fitted into the raster.
    std::optional<Homography<ProjectorFrame, CameraFrame>> registration;
    std::string provenance = "simulated";  ///< simulated, measured: never measured unless it was
    bool operator==(const Rig&) const = default;
};

/// Slots of one sweep: slotRate / sweepRate, rounded.
inline int slotsPerSweep(const Rig& rig) { return static_cast<int>(std::lround(rig.slotRate / rig.sweepRate)); }

}  // namespace ilf
