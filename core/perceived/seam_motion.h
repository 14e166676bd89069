// Seams of a region that moves: its two layers of light fall at different moments, and must agree where the edge is.
#pragma once

#include <optional>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

/// When a border's light falls in each sweep, by the middle of each slot.
struct EdgeLight {
    struct Pulse {
        Second at;
        double weight = 1.0;     ///< those of one layer add up to 1
        bool displaced = false;  ///< of the layer that is displaced; else of the other
    };
    Second period;
    std::vector<Pulse> pulses;
};
/// Of a border between light of level `displaced` and of level `other`, indices into Plan::levels. Precondition: both
/// have slots.
EdgeLight edgeLight(const Plan& plan, int displaced, int other);

/// Which moment the masks of a sweep are drawn for.
enum class MaskTiming {
    perPeriod,  ///< one place of the region for all slots of a sweep
    perSlot,    ///< each slot's own photon time, Slot::middle
};
enum class Watching {
    pursuit,  ///< the eye follows the edge
    still,    ///< the edge passes an eye that rests
};

/// A straight edge, blended by the closed form, that moves across itself.
struct MovingEdge {
    Metre feather = 10.0_mm;
    Metre blurRadius = 2.0_mm;
    double speed_m_s = 0.0;
    /// Within a sweep the region's place is predicted with a speed wrong by this part of it.
    double speedError = 0.0;
};

/// The largest difference from even light, as a share of it (Weber). Pursuit: where light falls on the retina stays the
/// same from sweep to sweep, so displaced layers leave v_err T / 2 over the feather. Still: light at each place of the
/// retina is filtered in time by a sum of nine equal leaky integrators, h(t) = (t / tau)^8 e^(-t / tau) / (8! tau) with
/// tau = 4.94 ms (the excitatory part of Watson, "Temporal Sensitivity", Handbook of Perception and Human Performance,
/// 1986; without its inhibition, so that slow changes pass); the ripple of even light itself is taken off.
double movingSeam(const EdgeLight& light, const MovingEdge& edge, MaskTiming timing, Watching watching);

/// The speed in m/s from which on the edge's seam exceeds `limit`; nothing up to 10 m/s.
std::optional<double> speedThatShows(const EdgeLight& light, MovingEdge edge, MaskTiming timing, Watching watching,
                                     double limit = 0.01);

/// W >= 2 v T: the feather for which two sweeps pass while the edge crosses it (scheduling 5).
Metre featherForSpeed(double speed_m_s, Second period);

}  // namespace ilf
