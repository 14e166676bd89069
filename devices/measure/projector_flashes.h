// The projector's known edge pattern: one flash after each trigger, by the same stage that plays shows.
#pragma once

#include <memory>

#include "devices/rig/lightcrafter_stage.h"

namespace ilf::devices {

struct FlashSetup {
    Size raster;
    Hertz sweepRate = 60.0_Hz, slotRate = 360.0_Hz;
};

/// All of the picture white in the sweep's first slot and dark in the others. In between, and at the end, the light is
/// steady and white.
class ProjectorFlashes {
public:
    /// `rig` without lenses: whoever measures holds them, at rest. Nothing is opened before the first flash.
    ProjectorFlashes(LightCrafterRig rig, FlashSetup setup);

    Result<void> flash(bool on);

private:
    LightCrafterStage stage_;
    FlashSetup setup_;
    Clock clock_;
};

}  // namespace ilf::devices
