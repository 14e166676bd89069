// Keeps the lenses' sweep in step with the projector by leaving samples out or repeating them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::devices {

struct PhaseLockSetup {
    int samplesPerSweep = 800;
    /// Where in the sweep, in samples, the projector's trigger shall come (from the rig's measured delay).
    double target = 0.0;
    /// How long a told slip needs to be heard: what the device and the stream buffer, in sweeps.
    int latencySweeps = 6;
};

/// What to do to the sweep, in samples (later is positive).
struct PhaseAdvice {
    enum class Kind {
        none,
        slip,   ///< by one sample
        align,  ///< by many, before light is slotted
    };
    Kind kind = Kind::none;
    int samples = 0;
    bool operator==(const PhaseAdvice&) const = default;
};

struct PhaseReport {
    bool locked = false;
    double driftPpm = 0.0;     ///< the projector's clock against the DAC's; above 0: the projector is slower
    Second rms, most;          ///< of the trigger's place in the sweep against its target, over the last two seconds
    Second jitter;             ///< standard deviation of the same
    std::int64_t edges = 0;    ///< taken
    std::int64_t missing = 0;  ///< triggers that should have come and did not
    std::int64_t strays = 0;   ///< edges where none could be
    std::int64_t slips = 0;
};

/// The projector's refresh is the master. Pure: time is counted in the DAC's samples and comes with each edge.
///
/// Each edge tells where it came relative to the nearest start of a sweep, and by how many samples that start had been
/// moved. The sum of both drifts evenly whatever was slipped; an alpha-beta filter follows it and says where the sweep
/// will stand once a slip told now is heard. A slip is told when that is more than 0.6 samples off, at most one in four
/// sweeps, and more than 1 sample off if it would go back on the last one.
///
/// Holds within +-2 samples (42 us) for clocks within 100 ppm and edges within +-1 sample; 200 ppm is the most it
/// tries. 59.94 against 60.00 Hz is 1000 ppm: refused with words, not chased.
class PhaseLock {
public:
    explicit PhaseLock(PhaseLockSetup setup) : setup_(setup) {}

    /// An edge at `sample` (of all samples played), `offset` after the nearest start of a sweep, which had been moved
    /// by `moved` samples in all. Errors (`unsupported`): the projector's rate is too far away. The advice must be
    /// followed.
    Result<PhaseAdvice> edge(double sample, double offset, std::int64_t moved);
    /// Tells that samples up to `sample` hold no other edge. Error (`device`): the trigger is lost, for six sweeps.
    Result<void> heard(double sample);
    bool locked() const { return locked_; }
    PhaseReport report() const;

private:
    struct Sighting {
        double sample = 0.0, phase = 0.0;
    };
    Result<PhaseAdvice> acquired();
    Result<PhaseAdvice> followed(double sweeps, double phase, double error);
    tl::unexpected<Error> tooFar(double perSweep) const;
    double wrapped(double samples) const;

    PhaseLockSetup setup_;
    std::vector<Sighting> first_;  ///< until there are enough to fit
    std::vector<double> errors_;   ///< of the last two seconds, a ring
    std::size_t oldest_ = 0;
    std::optional<double> last_;   ///< edge
    std::optional<double> since_;  ///< when listening for the first one began
    bool following_ = false, locked_ = false;
    double phase_ = 0.0, perSweep_ = 0.0;  ///< filtered: at the last edge, and its change
    std::int64_t told_ = 0;                ///< by how many samples the start will have been moved
    double sweepsSinceSlip_ = 1e9;
    int lastSlip_ = 0, settled_ = 0;
    PhaseReport counts_;
};

}  // namespace ilf::devices
