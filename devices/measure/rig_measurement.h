// What the steps of measuring a rig do on its devices, and what came of them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/document/rig.h"
#include "devices/measure/edge_delay.h"
#include "devices/measure/photodiode_lens.h"
#include "devices/measure/wizard.h"

namespace ilf::devices {

struct RigMeasurementSetup {
    RigDevices devices;
    Eye eye = Eye::left;
    Hertz rate = 60.0_Hz;
    Dioptre lensMin = -10.0_D, lensMax = 10.0_D;
    std::vector<StaticPower> known;  ///< see StaticSweepSetup
    std::function<double()> temperature_C;
    Provenance provenance = Provenance::measured;
    int steps = 15;  ///< of the static sweep, see StaticSweepSetup
    std::size_t waves = 40;
    int periods = 24;
    /// Begins or ends flashes of the projector at each trigger; empty: somebody else sees to it.
    std::function<Result<void>(bool flash)> flashes;
    std::function<bool()> stop;  ///< true: the step ends, not good, the lenses at rest
    MeasureWatch watch;
};

/// What was measured so far; a step that is done again replaces its own.
struct MeasuredRig {
    std::optional<EdgeDelays> delay;
    double dark_V = 0.0, rest_V = 0.0;
    std::optional<StaticSweep> sweep;
    std::vector<LensRecord> waves;
    double drift_D = 0.0;
};

/// Each step opens outputs and inputs anew and leaves the lenses at rest, whatever comes of it; between steps they hold
/// that rest. The lens rests at the current nearest to 0 D that is known of it.
class RigMeasurement {
public:
    /// `link`: a USB-1208FS-Plus that nobody else uses.
    RigMeasurement(std::shared_ptr<UsbLink> link, RigMeasurementSetup setup, Clock clock = Clock::steady());

    /// Never fails: what went wrong is an outcome that is not good.
    StepOutcome perform(MeasureStep step, const MeasureSaid& said = {});
    const MeasuredRig& measured() const { return measured_; }
    /// Runs `work` with a recorder of the lens as it was measured, for waves that are learnt. Errors: powers were not
    /// measured, and the recorder's.
    Result<void> withRecorder(const std::function<Result<void>(const RecordLens&, const DriveLimits&)>& work);

private:
    struct Opened;
    Result<Opened> opened();
    LensBench benchOn(Opened& devices) const;
    StepOutcome projector();
    StepOutcome dark(LensBench& bench);
    StepOutcome light(LensBench& bench);
    StepOutcome powers(LensBench& bench, const MeasureSaid& said);
    StepOutcome recorded(LensBench& bench, const MeasureSaid& said);
    StepOutcome drift(LensBench& bench);
    WaveRecording recording(const DriveLimits& limits) const;
    DriveLimits limits() const;

    std::shared_ptr<UsbLink> link_;
    RigMeasurementSetup setup_;
    Clock clock_;
    LensChannels channels_;
    MeasuredRig measured_;
};

/// The current at `power` on the straight lines between known points; 0 A where nothing is known.
Ampere currentAtRest(const std::vector<StaticPower>& powers, Dioptre power);

/// What AI0 (TRIG_OUT_2) and AI1 (photodiode) hear for `time`, as `delaysIn` judges it; light is converted 21 us after
/// the trigger, which is accounted for. Refused too: a delay of poor confidence, and a `stop` that says true.
Result<EdgeDelays> heardDelays(AnalogInput& input, const Clock& clock, Second time = Second::fromSi(2.0),
                               const MeasureWatch& watch = {}, const std::function<bool()>& stop = {});

}  // namespace ilf::devices
