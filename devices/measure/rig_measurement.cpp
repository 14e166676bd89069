#include "devices/measure/rig_measurement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

constexpr double kLeastLight_V = 0.1, kMostLight_V = 9.0, kMostDark_V = 1.0;
constexpr double kMostDrift_D = 0.1, kMostHysteresis_D = 0.3;
// For the first look at whether the lens moves: this share of the greatest current that is known.
constexpr double kFirstWave = 0.15;
// A flash of the projector lasts a slot, a millisecond or more.
constexpr Second kShortestFlash = 0.6_ms;
constexpr std::chrono::milliseconds kLook{20};

template <class... Values>
std::string text(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

StepOutcome failed(const Error& error) { return {false, "", error.what}; }

}  // namespace

struct RigMeasurement::Opened {
    std::unique_ptr<LensOutput> output;
    std::unique_ptr<AnalogInput> input;
};

Ampere currentAtRest(const std::vector<StaticPower>& powers, Dioptre power) {
    if (powers.empty()) return {};
    if (power <= powers.front().power) return powers.front().current;
    for (std::size_t i = 1; i < powers.size(); ++i) {
        if (power > powers[i].power) continue;
        const double share = (power - powers[i - 1].power) / (powers[i].power - powers[i - 1].power);
        return powers[i - 1].current + share * (powers[i].current - powers[i - 1].current);
    }
    return powers.back().current;
}

Result<EdgeDelays> heardDelays(AnalogInput& input, const Clock& clock, Second time, const MeasureWatch& watch,
                               const std::function<bool()>& stop) {
    Recording recording;
    recording.samplesPerSecond = input.samplesPerSecond();
    const auto wanted = static_cast<std::size_t>(time.si() * recording.samplesPerSecond);
    const auto until = clock.now() + std::chrono::nanoseconds(static_cast<std::int64_t>(2e9 * time.si()));
    while (recording.light.size() < wanted) {
        if (stop && stop()) return fail(Fault::device, "Measuring was stopped; the lenses rest.");
        const auto heard = input.take();
        if (!heard) return tl::unexpected(heard.error());
        if (watch.heard && !heard->second.empty()) watch.heard(*heard, recording.samplesPerSecond);
        recording.trigger.insert(recording.trigger.end(), heard->trigger.begin(), heard->trigger.end());
        recording.light.insert(recording.light.end(), heard->second.begin(), heard->second.end());
        if (clock.now() > until) return fail(Fault::device, "The DAC box has stopped listening. Connect it again.");
        clock.wait(kLook);
    }
    auto delays = delaysIn(recording, kShortestFlash);
    if (!delays) return delays;
    const double later = 1.0 / usb1208::kSampleRateHz;
    for (double& delay : delays->delay_s)
        delay += later;
    delays->delay = spreadOf(delays->delay_s);
    delays->mean = delays->mean + Second::fromSi(later);
    if (delays->confidence == Confidence::poor)
        return fail(Fault::device,
                    text("Light came after %d of %d triggers, with %d flashes of something else: too few to "
                         "trust. Shade the photodiode and bring it nearer to the light.",
                         delays->triggers - delays->missing, delays->triggers, delays->extra));
    return delays;
}

RigMeasurement::RigMeasurement(std::shared_ptr<UsbLink> link, RigMeasurementSetup setup, Clock clock)
    : link_(std::move(link)), setup_(std::move(setup)), clock_(std::move(clock)) {
    const auto rest = [&](bool measuredEye, const LensWiring& wiring) {
        return LensChannel{wiring.amplifier, currentAtRest(measuredEye ? setup_.known : wiring.powers, Dioptre())};
    };
    channels_.left = rest(setup_.eye == Eye::left, setup_.devices.left);
    channels_.right = rest(setup_.eye == Eye::right, setup_.devices.right);
}

Result<RigMeasurement::Opened> RigMeasurement::opened() {
    auto output = LensOutput::open(link_, {channels_, 4}, clock_);
    if (!output) return tl::unexpected(std::move(output.error()));
    auto input = AnalogInput::start(link_, Hearing::triggerAndAI1, clock_);
    if (!input) return tl::unexpected(std::move(input.error()));
    return Opened{*std::move(output), *std::move(input)};
}

LensBench RigMeasurement::benchOn(Opened& devices) const {
    LensBenchSetup setup;
    setup.channels = channels_;
    setup.eye = setup_.eye;
    setup.periods = setup_.periods;
    setup.stop = setup_.stop;
    setup.watch = setup_.watch;
    return LensBench(*devices.output, *devices.input, std::move(setup), clock_);
}

StepOutcome RigMeasurement::perform(MeasureStep step, const MeasureSaid& said) {
    if (step == MeasureStep::projector) return projector();
    auto devices = opened();
    if (!devices) return failed(devices.error());
    LensBench bench = benchOn(*devices);
    StepOutcome outcome;
    switch (step) {
    case MeasureStep::projector:
        break;
    case MeasureStep::dark:
        outcome = dark(bench);
        break;
    case MeasureStep::light:
        outcome = light(bench);
        break;
    case MeasureStep::powers:
        outcome = powers(bench, said);
        break;
    case MeasureStep::waves:
        outcome = recorded(bench, said);
        break;
    case MeasureStep::drift:
        outcome = drift(bench);
        break;
    }
    if (auto rested = bench.rest(); !rested && outcome.good) return failed(rested.error());
    return outcome;
}

StepOutcome RigMeasurement::projector() {
    measured_.delay.reset();
    if (setup_.flashes) {
        if (auto begun = setup_.flashes(true); !begun) return failed(begun.error());
    }
    auto devices = opened();
    Result<EdgeDelays> delays =
        devices ? heardDelays(*devices->input, clock_, Second::fromSi(2.0), setup_.watch, setup_.stop)
                : tl::unexpected(devices.error());
    if (setup_.flashes) {
        if (auto ended = setup_.flashes(false); !ended && delays) return failed(ended.error());
    }
    if (!delays) return failed(delays.error());
    StepOutcome outcome;
    outcome.good = true;
    outcome.measured =
        text("%.3f ms after the trigger, \u00b1 %.3f ms, over %d triggers (%d missing, %d too many); confidence %s",
             1e3 * delays->mean.si(), 1e3 * delays->delay.deviation.si(), delays->triggers, delays->missing,
             delays->extra, word(delays->confidence));
    measured_.delay = *std::move(delays);
    return outcome;
}

StepOutcome RigMeasurement::dark(LensBench& bench) {
    const auto steady = bench.held(bench.restCurrent());
    if (!steady) return failed(steady.error());
    measured_.dark_V = steady->volts;
    StepOutcome outcome;
    outcome.measured = text("%.3f V, noise %.1f mV", steady->volts, 1e3 * steady->noise_V);
    outcome.good = std::abs(steady->volts) < kMostDark_V;
    if (!outcome.good) outcome.advice = "That is bright for the dark: switch the laser off and shade the photodiode.";
    return outcome;
}

StepOutcome RigMeasurement::light(LensBench& bench) {
    const auto steady = bench.held(bench.restCurrent());
    if (!steady) return failed(steady.error());
    const double light_V = steady->volts - measured_.dark_V;
    StepOutcome outcome;
    outcome.measured =
        text("%.3f V at rest, %.3f V above the dark, noise %.1f mV", steady->volts, light_V, 1e3 * steady->noise_V);
    if (light_V < kLeastLight_V) {
        outcome.advice =
            "There is no light: switch the laser on, aim it through the lens's middle, check the photodiode.";
        return outcome;
    }
    if (steady->volts > kMostLight_V) {
        outcome.advice = "That is too bright to measure brighter powers: dim the laser or lower the photodiode's gain.";
        return outcome;
    }
    const auto& known = setup_.known;
    if (known.size() < 2) {
        outcome.advice =
            "Tell at least two currents and the lens's power at each; the photodiode alone knows no dioptres.";
        return outcome;
    }
    const double low = known.front().current.si(), high = known.back().current.si();
    const Harmonics first{{0.5 * (low + high), std::complex<double>(0.0, -kFirstWave * (high - low))}};
    const auto wave = bench.repeated(first, setup_.rate);
    if (!wave) return failed(wave.error());
    const double swing = std::abs(harmonicsOf(wave->volts, 1).c[1]);
    outcome.measured += text("; a wave of %.0f mA swings it by %.0f mV", 1e3 * kFirstWave * (high - low), 1e3 * swing);
    if (swing < 6.0 * wave->noise_V) {
        outcome.advice =
            "The light does not move with the drive: check that this lens is in the beam and its cable in.";
        return outcome;
    }
    measured_.rest_V = steady->volts;
    outcome.good = true;
    return outcome;
}

StepOutcome RigMeasurement::powers(LensBench& bench, const MeasureSaid& said) {
    measured_.sweep.reset();
    auto sweep = staticSweep(bench, {measured_.dark_V, setup_.known, setup_.steps}, said);
    if (!sweep) return failed(sweep.error());
    StepOutcome outcome;
    const auto& powers = sweep->powers;
    outcome.measured = text(
        "%zu currents from %.0f to %.0f mA: %.2f to %.2f D, rising all the way; up and down differ by %.3f D at most; "
        "known powers missed by %.3f D at most; noise %.4f D",
        powers.size(), 1e3 * powers.front().current.si(), 1e3 * powers.back().current.si(), powers.front().power.si(),
        powers.back().power.si(), sweep->hysteresis_D, sweep->scale.largestMiss_D, sweep->noise_D);
    outcome.good = sweep->hysteresis_D < kMostHysteresis_D;
    if (!outcome.good)
        outcome.advice =
            "The way up and the way down differ by more than a lens's hysteresis: something moved. Fix the "
            "set-up and measure again.";
    measured_.sweep = *std::move(sweep);
    return outcome;
}

DriveLimits RigMeasurement::limits() const {
    const LensWiring& wiring = setup_.eye == Eye::left ? setup_.devices.left : setup_.devices.right;
    return limitsOf(*measured_.sweep, wiring.amplifier, setup_.lensMin, setup_.lensMax);
}

WaveRecording RigMeasurement::recording(const DriveLimits& within) const {
    return {measured_.sweep->scale, within, setup_.temperature_C, setup_.provenance, 250};
}

StepOutcome RigMeasurement::recorded(LensBench& bench, const MeasureSaid& said) {
    measured_.waves.clear();
    if (!measured_.sweep) return {false, "", "Powers at rest must be measured first."};
    const DriveLimits within = limits();
    const RecordLens recorder = [this, record = photodiodeRecorder(bench, recording(within))](const Harmonics& drive,
                                                                                              Hertz rate) {
        auto wave = record(drive, rate);
        if (wave && setup_.watch.recorded) setup_.watch.recorded(*wave);
        return wave;
    };
    auto waves = recordedWaves(recorder, *measured_.sweep, within, setup_.rate, setup_.waves, said);
    if (!waves) return failed(waves.error());
    double noise_D = 0.0, low = HUGE_VAL, high = -HUGE_VAL;
    for (const LensRecord& wave : *waves) {
        noise_D = std::max(noise_D, wave.noise_D);
        const auto [least, most] = std::minmax_element(wave.power_D.begin(), wave.power_D.end());
        low = std::min(low, *least);
        high = std::max(high, *most);
    }
    measured_.waves = *std::move(waves);
    return {true,
            text("%zu waves at %.6g Hz from %.2f to %.2f D, noise of a sample %.4f D at most", measured_.waves.size(),
                 setup_.rate.si(), low, high, noise_D),
            ""};
}

StepOutcome RigMeasurement::drift(LensBench& bench) {
    if (!measured_.sweep) return {false, "", "Powers at rest must be measured first."};
    const auto steady = bench.held(bench.restCurrent());
    if (!steady) return failed(steady.error());
    const PowerScale& scale = measured_.sweep->scale;
    measured_.drift_D = scale.powerAt(steady->volts) - scale.powerAt(measured_.rest_V);
    StepOutcome outcome;
    outcome.measured = text("%+.3f D since the light was first seen", measured_.drift_D);
    outcome.good = std::abs(measured_.drift_D) < kMostDrift_D;
    if (!outcome.good)
        outcome.advice =
            "Laser, lens or set-up changed meanwhile. Let the laser and the lens warm up for ten minutes, then "
            "measure again from the dark on.";
    return outcome;
}

Result<void>
RigMeasurement::withRecorder(const std::function<Result<void>(const RecordLens&, const DriveLimits&)>& work) {
    if (!measured_.sweep) return fail(Fault::notFound, "Powers at rest must be measured before waves can be learnt.");
    auto devices = opened();
    if (!devices) return tl::unexpected(devices.error());
    LensBench bench = benchOn(*devices);
    const DriveLimits within = limits();
    auto done = work(photodiodeRecorder(bench, recording(within)), within);
    auto rested = bench.rest();
    return done ? rested : done;
}

}  // namespace ilf::devices
