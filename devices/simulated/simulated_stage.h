// The stage made of the simulated lens and projector: the order in which they are told what.
#pragma once

#include <optional>

#include "devices/simulated/device_port.h"
#include "devices/simulated/lens_model.h"
#include "devices/stage.h"

namespace ilf::devices {

/// Slots come on once the lens is predicted to be this near its wave: half of what the planner usually lets a level
/// err, the other half being the wave's own.
inline constexpr Dioptre kSettledLens = 0.05_D;

/// While slots are on show (scheduling 8): the phase between slots and sweep, and how far the lens may be from the
/// temperature its wave is predicted for.
inline constexpr Second kPhaseBudget = 200.0_us;
inline constexpr double kTemperatureBudget_C = 5.0;
/// A lens this far (rms over a sweep) from its predicted wave is told of in the status line; the show goes on.
inline constexpr Dioptre kOffWave = 0.25_D;

/// Starting is ordered: steady light, then the sweep, then slots; stopping is the same way back. A program with the
/// same wave and slot rate as the one that plays is swapped in without steady light between.
class SimulatedStage : public Stage {
public:
    explicit SimulatedStage(DevicePort& port) : port_(port) {}

    Result<void> load(const Program& program) override;
    Result<void> swap() override;
    Result<void> heartbeat() override;
    void safeLight() noexcept override;
    StageReport report() const override;
    std::string name() const override { return "simulated lens and projector"; }

private:
    Result<void> startSweep();
    Result<void> settled();
    Result<void> confirmed();
    Result<void> withinBudgets() const;
    Result<void> read();

    DevicePort& port_;
    Program loaded_;
    std::uint64_t loadedHash_ = 0;  ///< 0: nothing is known of the back buffer
    std::uint64_t shownHash_ = 0;   ///< 0: steady light
    std::optional<Waveform> told_;  ///< none: the lens rests
    Hertz slotRate_;                ///< 0: not told yet
    LensModel predicted_;
    std::optional<DeviceState> state_;  ///< what the devices said last; none if they do not answer
};

}  // namespace ilf::devices
