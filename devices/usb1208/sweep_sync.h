// The lenses kept in step with the projector: trigger heard, phase judged, sweep slipped.
#pragma once

#include <complex>
#include <optional>

#include "core/base/result.h"
#include "devices/clock.h"
#include "devices/usb1208/analog_input.h"
#include "devices/usb1208/edge_finder.h"
#include "devices/usb1208/lens_output.h"
#include "devices/usb1208/phase_lock.h"

namespace ilf::devices {

/// What is wired to AI1 while a show plays.
enum class Echo {
    /// Nothing. Where outputs stand against inputs is then known only to the length of two USB requests (1 ms and
    /// more),
    /// anew at each start: enough to notice drift, not enough for slots.
    none,
    /// AO0. The sweep's place is heard itself, to a fraction of a sample.
    leftOutput,
};

struct SyncReport {
    PhaseReport phase;
    /// Whether the place of the sweep is heard, and not only reckoned from when the scans were started.
    bool placeKnown = false;
};

/// Lives as long as one scan of `output`: after rest or another rate, make a new one. Slotted light may only be on
/// while `phase.locked` and `placeKnown`.
class SweepSync {
public:
    /// Both must outlive it. Precondition: `output` sweeps. `input` hears AI1 if there is an echo.
    SweepSync(LensOutput& output, AnalogInput& input, Echo echo, EdgeLevels levels = {}, double target = 0.0,
              Clock clock = Clock::steady());

    /// To be called every 20 to 100 ms: takes what was heard and slips or aligns the sweep. Errors are faults: the
    /// trigger is lost or too far from the sweep's rate, samples were lost, or the sweep is not where it should be.
    Result<SyncReport> step();

private:
    Result<void> heardEcho(const HeardBlock& block);
    Result<void> followed(double frame);

    LensOutput& output_;
    AnalogInput& input_;
    Echo echo_;
    EdgeFinder finder_;
    PhaseLock lock_;
    Clock clock_;
    double framesPerSample_;
    double origin_;  ///< the output's frame at the input's first sample
    std::chrono::nanoseconds lastHeard_;
    bool placeKnown_ = false;
    int waitingShift_ = 0;
    // What was heard of the echo since the last judgement.
    std::complex<double> sum_ = 0.0;
    double echoSamples_ = 0.0;
};

}  // namespace ilf::devices
