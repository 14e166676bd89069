// The stand-in scheduler: which slots of an ideal sine serve which level.
#pragma once

#include <optional>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

/// A level that has no slots yet.
struct LevelWish {
    LevelKind kind = LevelKind::focus;
    Dioptre power;
    /// Blur only: a slot whose mean power is below this would show a region sharp that must be blurred. It is left out,
    /// except the one at the end of the sweep, which is the best there is.
    std::optional<Dioptre> above;
};

struct Schedule {
    Waveform waveform;
    std::vector<Slot> slots;
    std::vector<Level> levels;  ///< as the wishes; one without slots is a level the sine cannot hold
    double light = 1.0;         ///< every level's luminance as a share of steady light
};

/// Each slot may serve the level nearest to it (least mean square error). Every level takes its slots in order of error
/// while their common rms stays in the budget: that gives the level most light (scheduling 3.1), and dimming all levels
/// to the darkest makes their luminance equal. A lens that stands still serves the first level in every slot.
Schedule scheduled(const Waveform& waveform, const Rig& rig, const std::vector<LevelWish>& wishes);

}  // namespace ilf
