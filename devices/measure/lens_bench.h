// One lens before a photodiode: currents in, volts out, at rest and over a sweep's period.
#pragma once

#include <functional>
#include <vector>

#include "core/base/result.h"
#include "core/document/wearer.h"
#include "core/lens/harmonics.h"
#include "devices/clock.h"
#include "devices/measure/measure_watch.h"
#include "devices/usb1208/analog_input.h"
#include "devices/usb1208/lens_output.h"

namespace ilf::devices {

struct LensBenchSetup {
    LensChannels channels;                  ///< those `output` was opened with
    Eye eye = Eye::left;                    ///< whose lens is before the photodiode; the other one rests
    int periods = 24;                       ///< averaged
    Second patience = Second::fromSi(3.0);  ///< for a lens to come to rest, or to repeat
    std::function<bool()> stop;             ///< true: end with an error, the lenses at rest
    MeasureWatch watch;
};

/// The photodiode while the lens's current stands still.
struct SteadyVolts {
    double volts = 0.0;
    double noise_V = 0.0;  ///< standard deviation of one sample, of 24000 a second
    int samples = 0;
    double error() const;  ///< standard deviation of `volts`
};

/// One period of the photodiode, averaged; x = 0 is when the drive's first sample was put out.
struct PeriodVolts {
    std::vector<double> volts;
    double first = 0.0;    ///< x of the first of them; they are 1/size apart
    double noise_V = 0.0;  ///< standard deviation of each
    int periods = 0;
    double echo = 0.0;  ///< heard drive against told one; 0: it stands still
};

/// AI1: the photodiode. AI0: the output that drives this lens (AO0 left, AO1 right), so that where in its sweep the
/// output stands is heard and not reckoned: reckoning errs by the length of two USB requests, a millisecond and more.
/// Light is taken to be slow against a sample: a photodiode's own time constant makes a wave that much later.
///
/// Both must outlive it; `input` hears both channels. Any error leaves the lenses at rest.
class LensBench {
public:
    LensBench(LensOutput& output, AnalogInput& input, LensBenchSetup setup, Clock clock = Clock::steady());

    /// Holds a current, waits until the light stands still, averages. Refused: currents beyond the amplifier's.
    /// Errors: light that does not come to rest, or that leaves what the input can hear; the devices'.
    Result<SteadyVolts> held(Ampere current);
    /// Plays a drive in amperes, waits until the light repeats, averages. Errors as above, and an echo that is not this
    /// drive: AI0 is wired wrongly.
    Result<PeriodVolts> repeated(const Harmonics& drive_A, Hertz rate);
    Result<void> rest() { return output_.safe(); }
    const Amplifier& amplifier() const;
    Ampere restCurrent() const;

private:
    struct Fold {
        std::vector<double> echo, light, square;  ///< sums over `sweeps`
        double first = 0.0;                       ///< x of AI0's first sample
        int sweeps = 0;
        double sampleNoise() const;
    };
    Result<HeardBlock> listened();
    Result<void> played(const Harmonics& drive_A, Hertz rate);
    Result<Fold> folded(int sweeps);
    Result<Fold> settled(int sweeps);
    Result<PeriodVolts> placed(Fold fold, const Harmonics& drive_A) const;
    template <class Value>
    Result<Value> rested(Result<Value> result);

    LensOutput& output_;
    AnalogInput& input_;
    LensBenchSetup setup_;
    Clock clock_;
    HeardBlock left_;  ///< heard and not folded yet
};

}  // namespace ilf::devices
