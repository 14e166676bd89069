// What a projector can show in one sweep, by its kind and the bits of its pictures.
#pragma once

#include "core/base/result.h"
#include "core/document/rig.h"

namespace ilf {

/// The shortest a picture of so many bits can be shown. LightCrafter 4500: exposure table of the maker's programmer's
/// guide (DLPU010; 235 us for 1 bit to 8333 us for 8), not measured. highSpeed: 1 / Rig::fastest.
Second shortestSlot(const Rig& rig);

/// The most slots of one sweep: as many as fit, and for a LightCrafter 24 bit planes in all.
int mostSlots(const Rig& rig);

/// Refuses (Fault::unsafe) slots that are too short or too many, with what would fit.
Result<void> checkedProjector(const Rig& rig);

/// The rig with another kind of projector and as many slots as that shows.
Rig withProjector(Rig rig, ProjectorKind kind, int bits);

/// What becomes of light in slots that are no whole multiple of the sweep: one slot a sweep, the one nearest its lowest
/// power, drifts against it and beats. The slowest component of more than 0.5 %; modulation as a share of the mean.
/// None: 0 Hz.
struct Beat {
    Hertz frequency;
    double modulation = 0.0;
};
Beat slowestBeat(Hertz slotRate, Hertz sweepRate);

}  // namespace ilf
