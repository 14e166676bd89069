// Lens and projector as one machine that plays programs.
#pragma once

#include <string>

#include "core/compile/program.h"

namespace ilf::devices {

enum class LightMode {
    steady,   ///< uniform white: safe
    slotted,  ///< a program's slots, sweep after sweep
};
enum class LensMode { rest, holding, sweeping };

/// What the devices said last, for status lines.
struct StageReport {
    LightMode light = LightMode::steady;
    LensMode lens = LensMode::rest;
    Dioptre lensPower, low, high;
    std::string projectorLine, lensLine;  ///< one line each: name and state
    std::string lensName;                 ///< "simulated lens, preset datasheet"
    bool well = false;                    ///< they answered
    bool simulated = true;
    bool operator==(const StageReport&) const = default;
};

/// Playing is in two steps so that a new program never appears half on one device and half on the other: `load` sends
/// everything beside what is playing, `swap` changes over at the start of the next sweep. Calls come from one thread.
class Stage {
public:
    virtual ~Stage() = default;

    /// Uploads `program`, sending only tiles that differ from what the devices already hold. What is on show goes on
    /// undisturbed.
    virtual Result<void> load(const Program& program) = 0;
    /// Puts the loaded program on show. Returns once the sweep it starts with has begun. A program with another
    /// waveform or slot rate first gets steady light, then the new sweep, then slots once the predicted lens error is
    /// inside its budget.
    virtual Result<void> swap() = 0;
    /// Checks that the devices are there and do what they were told; called every 100 ms while nothing else happens.
    virtual Result<void> heartbeat() = 0;
    /// Steady uniform white light, lens at rest: the projector is the room's light, so "off" is not safe.
    /// Works from any state and never fails (a device that cannot be reached is left to its own power-on state, which
    /// is the same).
    virtual void safeLight() noexcept = 0;
    /// What the last heartbeat or swap found.
    virtual StageReport report() const = 0;
    /// "simulated lens and projector", "emulated ..." - for status lines.
    virtual std::string name() const = 0;
};

}  // namespace ilf::devices
