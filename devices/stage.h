// Lens and projector as one machine that plays programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/compile/program.h"

namespace ilf::devices {

enum class LightMode {
    steady,   ///< uniform white: safe
    slotted,  ///< a program's slots, sweep after sweep
};
enum class LensMode { rest, holding, sweeping };

/// How far what is played has been from where it belongs, measured while slotted light is on.
struct StageTiming {
    bool locked = false;               ///< the sweep follows the projector
    Second phase;                      ///< the farthest of the last two seconds
    Second jitter;                     ///< standard deviation of the same
    double driftPpm = 0.0;             ///< of the lenses' clock against the projector's
    std::uint64_t missedTriggers = 0;  ///< since slots came on
    bool operator==(const StageTiming&) const = default;
};

enum class DeviceHealth : std::uint8_t {
    well,
    absent,     ///< never found
    unplugged,  ///< was there, is gone
    wrongMode,  ///< does something else than it was told
    silent,     ///< there, but does not answer, or refuses
};

/// One device of a rig, for the device panel.
struct DeviceLine {
    std::string what;  ///< "projector", "display", "lenses"
    DeviceHealth health = DeviceHealth::absent;
    std::string name;  ///< "LightCrafter 4500 at USB 1-2"
    std::string line;  ///< one sentence: what it does, or what is wrong and what would help
    bool operator==(const DeviceLine&) const = default;
};

/// What the devices said last, for status lines.
struct StageReport {
    LightMode light = LightMode::steady;
    LensMode lens = LensMode::rest;
    Dioptre lensPower, low, high;
    std::string projectorLine, lensLine;      ///< one line each: name and state
    std::string lensName;                     ///< "simulated lens, preset datasheet"
    bool well = false;                        ///< they answered
    bool simulated = true;                    ///< no light and no lens of the real world
    bool emulated = false;                    ///< the drivers of real devices, over emulated cables; also simulated
    std::optional<StageTiming> timing;        ///< none: nothing is measured, or no slotted light
    std::optional<double> lensTemperature_C;  ///< none: nobody measures it
    std::vector<DeviceLine> devices;          ///< empty: the stage has no devices of their own
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
