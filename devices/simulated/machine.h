// The simulated lens and projector: what they do when told, with time as an argument instead of a clock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "devices/link/messages.h"
#include "devices/simulated/emulated_lens.h"
#include "devices/simulated/lens_model.h"

namespace ilf::devices {

/// Switched on it shows steady white light and rests at 0 D. The lens obeys whatever it is told; the projector refuses
/// a new slot rate while slots are on show, as a DMD controller does. An emulated lens refuses waves it has no drive
/// for; the ideal one takes powers. Times are in nanoseconds and never go back.
class Machine {
public:
    explicit Machine(std::int64_t now_ns = 0, SimulatedLens lens = {});

    /// Does what `request` asks and answers it: Done, Refused, DeviceState or SlotImage.
    Body answered(const Body& request, std::int64_t now_ns);
    /// Lets time pass: a swap that is due happens.
    void advance(std::int64_t now_ns);

    /// The driver's watchdog: when the player, who says so here, is not heard of for `limit` while slots are on show,
    /// the machine goes to its power-on state. The last guard, for a player and a supervisor that die together.
    void playerHeard(std::int64_t now_ns) { heardNs_ = now_ns; }
    void setWatchdog(std::optional<std::int64_t> limit_ns) { watchdogNs_ = limit_ns; }

    LightMode light() const { return light_; }
    LensMode lens() const { return lensMode_; }
    const Program* shown() const { return light_ == LightMode::slotted ? &front_ : nullptr; }
    DeviceState state(std::int64_t now_ns) const;

private:
    Body obeyed(const ProgramUpdate& update);
    Body obeyed(const SetWaveform& order, std::int64_t now_ns);
    Body obeyed(const SetSlotRate& order, std::int64_t now_ns);
    Body obeyed(const Swap& order, std::int64_t now_ns);
    Body obeyed(const SteadyLight& order, std::int64_t now_ns);
    Body obeyed(const LensToRest& order, std::int64_t now_ns);
    Body obeyed(const ReadSlot& order) const;
    Body obeyed(const InjectFault& order, std::int64_t now_ns);
    Body refused(std::string why, bool sendWhole = false);
    void note(std::string line);

    LightMode light_ = LightMode::steady;
    LensMode lensMode_ = LensMode::rest;
    LensModel lens_;                        ///< the wave and when its sweeps start; the ideal lens's power too
    std::optional<EmulatedLens> emulated_;  ///< none: the ideal lens
    std::string lensName_;
    bool dropTrigger_ = false;  ///< the next one
    Second slotsLate_;          ///< by triggers that were lost
    Hertz slotRate_ = 960.0_Hz;
    Program back_, front_;
    std::uint64_t backHash_ = 0, frontHash_ = 0;  ///< 0: nothing
    std::optional<std::int64_t> swapAtNs_;
    std::int64_t heardNs_ = 0;
    std::optional<std::int64_t> watchdogNs_;
    std::vector<std::uint64_t> imageHashes_;  ///< of front_
    DeviceState counters_;                    ///< its counters; the rest is filled in by state()
    std::deque<std::string> log_;
};

}  // namespace ilf::devices
