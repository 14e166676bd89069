// What a stage asks of the lenses: waves in step with the projector, rest, and how they are.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/lens/waveform.h"

namespace ilf::devices {

struct LensCondition {
    bool sweeping = false;                ///< plays what it was told; false: at rest
    std::optional<double> temperature_C;  ///< none: not known, as with an amplifier that has no sensor
};

/// Of the projector's triggers in the lens's sweep.
struct PhaseState {
    bool locked = false;
    Second most;  ///< farthest from its place in the last two seconds
    double driftPpm = 0.0;
    std::int64_t missing = 0;  ///< triggers that did not come, one by one; many in a row are an error
    Second jitter{};           ///< standard deviation of their place, over the same two seconds
};

/// Calls come from one thread. After any error the lenses may be anywhere; only `safe` is called then.
class StageLens {
public:
    virtual ~StageLens() = default;

    /// Plays `wave` (no still one moves) with the projector's triggers `triggerAhead` before its sweeps' starts, which
    /// is where slot 0's light begins. Returns how long it takes until this wave plays alone; the lens settles after
    /// that. A wave that cannot be played is refused and changes nothing.
    virtual Result<Second> play(const Waveform& wave, Second triggerAhead) = 0;
    /// Keeps the sweep in step; called every 20 to 100 ms while the projector's patterns run. Errors: triggers are
    /// lost, too far from the sweep's rate, or the sweep is not where it should be.
    virtual Result<PhaseState> follow() = 0;
    /// Whether the lenses do what they were told.
    virtual Result<LensCondition> heartbeat() = 0;
    /// Ramps to `rest` and holds it.
    virtual Result<void> safe() = 0;
    /// The power at which it was opened to rest.
    virtual Dioptre rest() const = 0;
    virtual std::string name() const = 0;
};

}  // namespace ilf::devices
