#include "devices/measure/photodiode_lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/lens/continuous_model.h"

namespace ilf::devices {
namespace {

// A lens whose light changes less than so many standard deviations over the whole sweep does not move.
constexpr double kMoves = 20.0;
constexpr double kMostMiss_D = 0.15;
// Known powers may be passed by this share of their range: resonance carries a wave beyond where the lens can rest.
constexpr double kBeyond = 0.25;
// Of the drive's limits: records are noisy and so is what is drawn from them.
constexpr double kNearLimit = 0.98;
// The photodiode's noise ends a wave's harmonics long before; the lens has none so high.
constexpr std::size_t kHarmonics = 40;

void say(const MeasureSaid& said, const std::string& what) {
    if (said) said(what);
}

std::string milliamperes(double amperes) {
    return std::to_string(static_cast<int>(std::lround(1e3 * amperes))) + " mA";
}

std::string decimals(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

/// Between the first and the last known current, those included, ascending.
std::vector<double> currentsOf(const StaticSweepSetup& setup) {
    std::vector<double> currents;
    currents.reserve(setup.known.size() + static_cast<std::size_t>(setup.steps));
    for (const StaticPower& one : setup.known)
        currents.push_back(one.current.si());
    const double low = currents.front(), high = currents.back(), step = (high - low) / (setup.steps - 1);
    for (int i = 1; i + 1 < setup.steps; ++i) {
        const double current = low + step * i;
        const bool near = std::any_of(currents.begin(), currents.end(),
                                      [&](double other) { return std::abs(other - current) < 0.3 * step; });
        if (!near) currents.push_back(current);
    }
    std::sort(currents.begin(), currents.end());
    return currents;
}

Result<void> checked(const StaticSweepSetup& setup) {
    const auto& known = setup.known;
    if (known.size() < 2)
        return fail(Fault::outOfRange,
                    "Tell at least two currents and the lens's power at each (from a lensmeter or its "
                    "certificate); the photodiode alone knows no dioptres.");
    for (std::size_t i = 1; i < known.size(); ++i) {
        if (!(known[i].current > known[i - 1].current) || !(known[i].power > known[i - 1].power))
            return fail(Fault::outOfRange, "The known powers must rise with their currents, from line to line.");
    }
    if (setup.steps < 3) return fail(Fault::outOfRange, "A static sweep needs at least three steps.");
    return {};
}

Harmonics sine(double offset, double amplitude) {
    return amplitude == 0.0 ? Harmonics{{offset}} : Harmonics{{offset, std::complex<double>(0.0, -amplitude)}};
}

/// Linear between two points, on beyond the ends.
double currentFor(const StaticSweep& sweep, double power_D) {
    const auto& powers = sweep.powers;
    std::size_t i = 1;
    while (i + 1 < powers.size() && powers[i].power.si() < power_D)
        ++i;
    const double p0 = powers[i - 1].power.si(), p1 = powers[i].power.si();
    const double c0 = powers[i - 1].current.si(), c1 = powers[i].current.si();
    return c0 + (power_D - p0) / (p1 - p0) * (c1 - c0);
}

}  // namespace

Result<StaticSweep> staticSweep(LensBench& bench, const StaticSweepSetup& setup, const MeasureSaid& said) {
    if (auto fine = checked(setup); !fine) return tl::unexpected(fine.error());
    const auto currents = currentsOf(setup);
    std::vector<SteadyVolts> up, down(currents.size());
    // The lowest is come to from above and the highest from below, as all others are on either way.
    if (auto begun = bench.held(bench.restCurrent()); !begun) return tl::unexpected(begun.error());
    const std::size_t all = 2 * currents.size();
    for (std::size_t i = 0; i < currents.size(); ++i) {
        say(said, "current " + std::to_string(i + 1) + " of " + std::to_string(all));
        auto steady = bench.held(Ampere::fromSi(currents[i]));
        if (!steady) return tl::unexpected(std::move(steady.error()));
        up.push_back(*steady);
    }
    for (std::size_t i = currents.size(); i-- > 0;) {
        say(said, "current " + std::to_string(all - i) + " of " + std::to_string(all));
        auto steady = bench.held(Ampere::fromSi(currents[i]));
        if (!steady) return tl::unexpected(std::move(steady.error()));
        down[i] = *steady;
    }

    const double range = std::abs(up.back().volts - up.front().volts);
    double error_V = 0.0;
    for (const SteadyVolts& one : up)
        error_V = std::max(error_V, one.error());
    if (range < kMoves * error_V || range < 0.02)
        return fail(Fault::device,
                    "The light does not follow the current. Check that the lens before the photodiode is the "
                    "one that is driven, that its cable is in, and that the beam goes through its middle.");
    std::vector<VoltsAtPower> known;
    for (const StaticPower& one : setup.known) {
        const auto at =
            static_cast<std::size_t>(std::find(currents.begin(), currents.end(), one.current.si()) - currents.begin());
        known.push_back({0.5 * (up[at].volts + down[at].volts), one.power.si()});
    }
    auto scale = powerScale(known, setup.dark_V);
    if (!scale) return tl::unexpected(scale.error());
    StaticSweep sweep;
    sweep.scale = *std::move(scale);
    sweep.leastSlope_D_per_A = HUGE_VAL;
    for (std::size_t i = 0; i < currents.size(); ++i) {
        const double rising = sweep.scale.powerAt(up[i].volts), falling = sweep.scale.powerAt(down[i].volts);
        const double power = 0.5 * (rising + falling);
        if (!std::isfinite(power))
            return fail(Fault::device,
                        "At " + milliamperes(currents[i]) + " there is no light; keep the set-up still.");
        sweep.powers.push_back({Ampere::fromSi(currents[i]), Dioptre::fromSi(power)});
        sweep.hysteresis_D = std::max(sweep.hysteresis_D, std::abs(rising - falling));
        sweep.noise_D = std::max(sweep.noise_D, std::abs(up[i].error() / sweep.scale.slopeAt(up[i].volts)));
        if (i == 0) continue;
        for (const auto* way : {&up, &down}) {
            const double step = sweep.scale.powerAt((*way)[i].volts) - sweep.scale.powerAt((*way)[i - 1].volts);
            sweep.leastSlope_D_per_A = std::min(sweep.leastSlope_D_per_A, step / (currents[i] - currents[i - 1]));
        }
        if (!(sweep.leastSlope_D_per_A > 0.0))
            return fail(Fault::device, "The lens's power does not rise from " + milliamperes(currents[i - 1]) + " to " +
                                           milliamperes(currents[i]) +
                                           ". Keep the set-up still, shade it from other light, and measure again.");
    }
    if (sweep.scale.largestMiss_D > kMostMiss_D)
        return fail(Fault::device,
                    "A known power lies " + decimals(sweep.scale.largestMiss_D) +
                        " D beside what the photodiode says. Check the known powers and their currents.");
    sweep.slope_D_per_A =
        (sweep.powers.back().power - sweep.powers.front().power).si() / (currents.back() - currents.front());
    return sweep;
}

DriveLimits limitsOf(const StaticSweep& sweep, const Amplifier& amplifier, Dioptre lensMin, Dioptre lensMax) {
    DriveLimits limits;
    const double low = sweep.powers.front().current.si(), high = sweep.powers.back().current.si();
    limits.peak = std::min(amplifier.most.si(), std::max(std::abs(low), std::abs(high)));
    limits.rms = limits.peak / std::numbers::sqrt2;
    limits.lensMin = lensMin;
    limits.lensMax = lensMax;
    return limits;
}

RecordLens photodiodeRecorder(LensBench& bench, WaveRecording setup) {
    return [&bench, setup = std::move(setup)](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
        if (!isFinite(drive)) return fail(Fault::outOfRange, "The lens's drive has a value that is not a number.");
        const Extremes ends = extremes(drive);
        const double peak = std::max(std::abs(ends.low), std::abs(ends.high));
        if (peak > setup.limits.peak * (1.0 + 1e-6) || drive.rms() > setup.limits.rms * (1.0 + 1e-6))
            return fail(Fault::outOfRange, "The drive reaches " + milliamperes(peak) + " (" +
                                               milliamperes(drive.rms()) + " rms), more than the " +
                                               milliamperes(setup.limits.peak) + " (" + milliamperes(setup.limits.rms) +
                                               ") that the lens was measured with; ask for a narrower sweep.");
        const auto period = bench.repeated(drive, rate);
        if (!period) return tl::unexpected(period.error());
        const PowerScale& scale = setup.scale;
        const double beyond = kBeyond * (scale.high_D - scale.low_D);
        std::vector<double> powers;
        double slope = 0.0;
        for (const double volts : period->volts) {
            const double power = scale.powerAt(volts);
            if (!(power > scale.low_D - beyond && power < scale.high_D + beyond))
                return fail(Fault::outOfRange,
                            "With this drive the lens goes far beyond the powers that are known of it; "
                            "tell more known powers, or ask for a narrower sweep.");
            powers.push_back(power);
            slope += std::abs(scale.slopeAt(volts)) / static_cast<double>(period->volts.size());
        }
        LensRecord record;
        record.family = drive.c.size() <= 2 ? "sine" : "multisine";
        record.rate = rate;
        record.drive = drive;
        record.unit = DriveUnit::ampere;
        // Sample 0 shall be the drive's x = 0.
        const std::size_t count = std::min(kHarmonics, powers.size() / 2 - 1);
        record.power_D =
            samplesOf(harmonicsOf(powers, count).delayed(period->first), static_cast<std::size_t>(setup.samples));
        record.periodsAveraged = period->periods;
        const double kept = std::sqrt(static_cast<double>(2 * count + 1) / static_cast<double>(powers.size()));
        record.noise_D = kept * period->noise_V / slope;
        record.temperature_C = setup.temperature_C ? setup.temperature_C() : 30.0;
        record.provenance = setup.provenance;
        return record;
    };
}

Result<std::vector<LensRecord>> recordedWaves(const RecordLens& record, const StaticSweep& sweep,
                                              const DriveLimits& limits, Hertz rate, std::size_t waves,
                                              const MeasureSaid& said) {
    if (waves < 9)
        return fail(Fault::outOfRange,
                    "A survey of the lens needs at least 9 waves, not " + std::to_string(waves) + "; 40 are usual.");
    const double most = kNearLimit * limits.peak;
    // A little inside the known powers, where waves are to stay.
    const double lowest = std::max(limits.lensMin.si(), sweep.scale.low_D);
    const double highest = std::min(limits.lensMax.si(), sweep.scale.high_D);
    const double low = std::max(-most, currentFor(sweep, lowest)), high = std::min(most, currentFor(sweep, highest));
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    std::vector<LensRecord> records;
    const auto add = [&](const Harmonics& drive) -> Result<void> {
        auto one = record(drive, rate);
        if (!one) return tl::unexpected(std::move(one.error()));
        one->id = static_cast<std::int64_t>(records.size()) + 1;
        records.push_back(*std::move(one));
        say(said, "wave " + std::to_string(records.size()) + " of " + std::to_string(waves + 3));
        return {};
    };
    const double small = 0.15 * half;
    for (const double offset : {middle - 0.4 * half, middle + 0.4 * half, middle}) {
        if (auto done = add(sine(offset, offset == middle ? small : 0.5 * small)); !done)
            return tl::unexpected(done.error());
    }
    const double swing = std::abs(harmonicsOf(records.back().power_D, 1).c[1]);
    if (!(swing > 4.0 * records.back().noise_D))
        return fail(Fault::device, "The lens stands still although it is driven with a wave of " + milliamperes(small) +
                                       "; check its cable.");
    const double perAmpere = swing / small;
    double largest = 0.49 * (highest - lowest) / perAmpere;
    largest = std::min({largest, most - std::abs(middle), 0.98 * limits.rms * std::numbers::sqrt2 - std::abs(middle)});
    for (const SineDrive& drive : drivesToRecord(low, high, waves, largest)) {
        const double room = most - std::abs(drive.offset);
        const double warm = 2.0 * (0.96 * limits.rms * limits.rms - drive.offset * drive.offset);
        const double amplitude = std::min({drive.amplitude, room, std::sqrt(std::max(0.0, warm))});
        if (!(amplitude > 0.0)) continue;
        if (auto done = add(sine(drive.offset, amplitude)); !done) return tl::unexpected(done.error());
    }
    return records;
}

}  // namespace ilf::devices
