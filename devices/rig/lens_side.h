// The lenses of a stage whose projector keeps the time: opened, told, settled, in step, watched, rested.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "devices/clock.h"
#include "devices/rig/known_device.h"
#include "devices/rig/stage_lens.h"
#include "devices/simulated/lens_model.h"
#include "devices/stage.h"

namespace ilf::devices {

/// After any error only `rest` may follow, which the stage calls once its light is white. Calls come from one thread.
class LensSide {
public:
    using Open = std::function<Result<std::unique_ptr<StageLens>>(Dioptre rest)>;
    /// `triggers`: the projector's output that keeps the time, as operators find it written.
    LensSide(Open open, Clock clock, std::string triggers = "the projector's trigger output")
        : open_(std::move(open)), clock_(std::move(clock)), triggers_(std::move(triggers)) {}

    bool there() const { return lens_ != nullptr; }
    /// Told to rest, without objection.
    bool resting() const { return resting_; }
    bool plays(const Waveform& wave, Second triggerAhead) const { return told_ == wave && ahead_ == triggerAhead; }

    /// Where they rest from now on; lenses that rest elsewhere are rested and let go.
    Result<void> restsAt(Dioptre rest);
    /// Opens them if they are not.
    Result<void> opened();
    /// Plays the wave (a change of it: never under slotted light) and waits until it is predicted to be settled.
    Result<void> settled(const Waveform& wave, Second triggerAhead);
    /// Follows the projector's triggers until the sweep is locked to them and has settled where they moved it.
    Result<void> inStep();
    /// Whether they do what they were told, at a temperature their wave is planned for, and, while the projector gives
    /// triggers, in step with it.
    Result<void> well(bool triggersCome);
    /// Ramps them to rest; lenses that fail in that, or failed before, are let go. The error is the rest's own.
    Result<void> rest();
    /// Nothing is wrong any more: slots are lit.
    void cleared() { known_.cleared(); }

    /// Fills in what concerns lenses; `slotted`: slots are on.
    void report(StageReport& into, bool slotted) const;
    DeviceLine line() const;

private:
    tl::unexpected<Error> failed(const Error& error);
    Result<void> atItsTemperature();
    void wait(std::chrono::nanoseconds time);
    std::string phaseWords() const;

    Open open_;
    Clock clock_;
    std::string triggers_;
    std::unique_ptr<StageLens> lens_;
    KnownDevice known_{"lenses", "USB-1208FS-Plus"};
    bool failed_ = false;  ///< to be opened anew once they rest
    bool resting_ = false;
    std::optional<Waveform> told_;  ///< none: they rest
    Second ahead_;
    Dioptre rest_;
    LensModel predicted_;
    Second settling_;
    std::optional<PhaseState> phase_;
    std::int64_t missingBefore_ = 0;  ///< triggers, when the sweep was locked
    std::optional<double> temperature_C_;
    std::chrono::nanoseconds lockedSince_{0};
};

}  // namespace ilf::devices
