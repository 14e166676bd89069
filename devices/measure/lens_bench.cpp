#include "devices/measure/lens_bench.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "devices/measure/echo_place.h"
#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

constexpr std::chrono::milliseconds kLook{20};
// By how much the reckoned place of the sweep may be off: 50 ms.
constexpr std::chrono::milliseconds kUnsure{50};
constexpr std::chrono::milliseconds kSilence{500};
// Over so many sweeps the light is compared with itself: 0.1 s at 60 Hz.
constexpr int kCompared = 6;
// Two such means differ by noise alone when they differ by less than this many of its standard deviations. The rest is
// for light that an input of 4.9 mV a step shows as one step or the next.
constexpr double kAlike = 1.3, kAlikeVolts = 2e-3;
// The input hears +-10 V.
constexpr double kMostVolts = 9.9;
constexpr Hertz kStillRate = 60.0_Hz;

double meanOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace

double SteadyVolts::error() const { return samples > 0 ? noise_V / std::sqrt(static_cast<double>(samples)) : noise_V; }

double LensBench::Fold::sampleNoise() const {
    if (sweeps < 2) return 0.0;
    double sum = 0.0;
    const double n = sweeps;
    for (std::size_t i = 0; i < light.size(); ++i)
        sum += std::max(0.0, square[i] - light[i] * light[i] / n) / (n - 1.0);
    return std::sqrt(sum / static_cast<double>(light.size()));
}

LensBench::LensBench(LensOutput& output, AnalogInput& input, LensBenchSetup setup, Clock clock)
    : output_(output), input_(input), setup_(std::move(setup)), clock_(std::move(clock)) {}

const Amplifier& LensBench::amplifier() const {
    return (setup_.eye == Eye::left ? setup_.channels.left : setup_.channels.right).amplifier;
}
Ampere LensBench::restCurrent() const {
    return (setup_.eye == Eye::left ? setup_.channels.left : setup_.channels.right).rest;
}

template <class Value>
Result<Value> LensBench::rested(Result<Value> result) {
    if (!result) static_cast<void>(output_.safe());  // why it was needed is what the operator must read
    return result;
}

Result<HeardBlock> LensBench::listened() {
    if (setup_.stop && setup_.stop()) return fail(Fault::device, "Measuring was stopped; the lenses rest.");
    if (auto well = output_.heartbeat(); !well) return tl::unexpected(std::move(well.error()));
    auto heard = input_.take();
    if (heard && setup_.watch.heard && !heard->second.empty()) setup_.watch.heard(*heard, input_.samplesPerSecond());
    return heard;
}

Result<void> LensBench::played(const Harmonics& drive_A, Hertz rate) {
    const auto wave = [&](bool measured, const LensChannel& channel) {
        Waveform driven;
        driven.rate = rate;
        driven.unit = DriveUnit::ampere;
        driven.drive = measured ? drive_A : Harmonics{{channel.rest.si()}};
        return driven;
    };
    const bool left = setup_.eye == Eye::left;
    const auto change = output_.play(wave(left, setup_.channels.left), wave(!left, setup_.channels.right));
    if (!change) return tl::unexpected(change.error());
    // While it changes, what is heard is let go.
    const auto until =
        clock_.now() + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * change->wait().si())) + kUnsure;
    while (clock_.now() < until) {
        if (auto heard = listened(); !heard) return tl::unexpected(std::move(heard.error()));
        clock_.wait(kLook);
    }
    // What is heard from now on was put out after the change.
    auto heard = input_.take();
    if (!heard) return tl::unexpected(heard.error());
    left_ = {};
    left_.firstSample = heard->firstSample + static_cast<std::int64_t>(heard->trigger.size());
    return {};
}

/// Samples of each channel come every second frame: of an even number of frames a sweep they repeat, of an odd one they
/// fall between the last sweep's.
Result<LensBench::Fold> LensBench::folded(int sweeps) {
    const auto sweep = static_cast<std::size_t>(output_.samplesPerSweep());
    const double perSample = usb1208::kSampleRateHz / input_.samplesPerSecond();
    const std::size_t step = sweep % 2 == 0 ? 1 : 2, bins = sweep % 2 == 0 ? sweep / 2 : sweep;
    const auto wanted = static_cast<std::size_t>(sweeps) * bins / step;
    auto last = clock_.now();
    while (left_.trigger.size() < wanted) {
        auto heard = listened();
        if (!heard) return tl::unexpected(std::move(heard.error()));
        if (!heard->trigger.empty()) last = clock_.now();
        if (clock_.now() - last > kSilence)
            return fail(Fault::device, "The DAC box has stopped listening. Connect it again.");
        left_.trigger.insert(left_.trigger.end(), heard->trigger.begin(), heard->trigger.end());
        left_.second.insert(left_.second.end(), heard->second.begin(), heard->second.end());
        if (left_.trigger.size() < wanted) clock_.wait(kLook);
    }
    Fold fold;
    const double origin =
        std::chrono::duration<double>(input_.startedAt() - output_.startedAt()).count() * usb1208::kSampleRateHz;
    const auto place = output_.placeOf(origin + static_cast<double>(left_.firstSample) * perSample);
    if (!place) return fail(Fault::device, "The lens's sweep is no longer known. Measure again.");
    fold.first = place->offset / static_cast<double>(sweep);
    fold.sweeps = sweeps;
    fold.echo.assign(bins, 0.0);
    fold.light.assign(bins, 0.0);
    fold.square.assign(bins, 0.0);
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t bin = i * step % bins;
        const double volts = left_.second[i];
        if (std::abs(volts) > kMostVolts)
            return fail(Fault::device, "The photodiode gives more than the input can hear. Dim the laser, or lower the "
                                       "photodiode amplifier's gain.");
        fold.echo[bin] += left_.trigger[i];
        fold.light[bin] += volts;
        fold.square[bin] += volts * volts;
    }
    const auto used = static_cast<std::ptrdiff_t>(wanted);
    left_.trigger.erase(left_.trigger.begin(), left_.trigger.begin() + used);
    left_.second.erase(left_.second.begin(), left_.second.begin() + used);
    left_.firstSample += used;
    if (step == 2) fold.sweeps = std::max(1, sweeps / 2);  // each place was heard in every other sweep
    return fold;
}

Result<LensBench::Fold> LensBench::settled(int sweeps) {
    std::vector<double> before;
    const double compared_s = kCompared * output_.samplesPerSweep() / usb1208::kSampleRateHz;
    const auto tries = static_cast<int>(std::ceil(setup_.patience.si() / compared_s));
    int alike = 0;
    for (int i = 0; i < std::max(tries, 4) && alike < 2; ++i) {
        auto fold = folded(kCompared);
        if (!fold) return fold;
        std::vector<double> now = fold->light;
        for (double& volts : now)
            volts /= fold->sweeps;
        if (!before.empty()) {
            double sum = 0.0;
            for (std::size_t k = 0; k < now.size(); ++k)
                sum += (now[k] - before[k]) * (now[k] - before[k]);
            const double apart = std::sqrt(sum / static_cast<double>(now.size()));
            const double noise = fold->sampleNoise() * std::sqrt(2.0 / fold->sweeps);
            // Noise averages out of the whole period's mean, which therefore tells slow drift apart from it.
            const double drift = std::abs(meanOf(now) - meanOf(before));
            const double driftNoise = noise / std::sqrt(static_cast<double>(now.size()));
            const bool same = apart <= kAlike * noise + kAlikeVolts && drift <= 3.0 * driftNoise + 0.5 * kAlikeVolts;
            alike = same ? alike + 1 : 0;
        }
        before = std::move(now);
    }
    if (alike < 2)
        return fail(Fault::device,
                    "The light through the lens does not come to repeat itself. Keep the set-up still, shade "
                    "it from other light, and check the lens's cable.");
    return folded(sweeps);
}

Result<SteadyVolts> LensBench::held(Ampere current) {
    const auto measured = [&]() -> Result<SteadyVolts> {
        if (auto told = played(Harmonics{{current.si()}}, kStillRate); !told) return tl::unexpected(told.error());
        const auto fold = settled(setup_.periods / 2 + 1);
        if (!fold) return tl::unexpected(fold.error());
        SteadyVolts steady;
        steady.volts = meanOf(fold->light) / fold->sweeps;
        steady.noise_V = fold->sampleNoise();
        steady.samples = fold->sweeps * static_cast<int>(fold->light.size());
        return steady;
    };
    return rested(measured());
}

Result<PeriodVolts> LensBench::repeated(const Harmonics& drive_A, Hertz rate) {
    const auto measured = [&]() -> Result<PeriodVolts> {
        if (auto told = played(drive_A, rate); !told) return tl::unexpected(told.error());
        auto fold = settled(setup_.periods);
        if (!fold) return tl::unexpected(fold.error());
        return placed(*std::move(fold), drive_A);
    };
    return rested(measured());
}

Result<PeriodVolts> LensBench::placed(Fold fold, const Harmonics& drive_A) const {
    const double sweep = output_.samplesPerSweep(), sampleNoise_V = fold.sampleNoise();
    for (double& volts : fold.echo)
        volts /= fold.sweeps;
    for (double& volts : fold.light)
        volts /= fold.sweeps;
    Harmonics told = drive_A;
    for (auto& c : told.c)
        c *= amplifier().dac.si();
    const auto echo = echoPlace(fold.echo, fold.first, told, sweep);
    if (!echo)
        return fail(Fault::device, std::string("AI0 does not hear the lens's drive. Wire ") +
                                       (setup_.eye == Eye::left ? "AO0" : "AO1") +
                                       " to AI0 as well as to the amplifier, and the photodiode to AI1.");
    PeriodVolts period;
    period.volts = std::move(fold.light);
    // AI1 is converted one frame after AI0.
    period.first = fold.first + echo->later + 1.0 / sweep;
    period.noise_V = sampleNoise_V / std::sqrt(static_cast<double>(fold.sweeps));
    period.periods = fold.sweeps;
    period.echo = echo->gain;
    return period;
}

}  // namespace ilf::devices
