#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {
namespace {

// What a drive may exceed a limit by and still count as at it: rounding, not will.
constexpr double kRounding = 1.0 + 1e-9;

std::string millivolts(double volt) {
    std::string out(32, '\0');
    out.resize(static_cast<std::size_t>(std::snprintf(out.data(), out.size(), "%.1f mV", 1e3 * volt)));
    return out;
}

}  // namespace

Result<void> playable(const Harmonics& drive, Hertz rate, const DriveLimits& limits) {
    if (!isFinite(drive))
        return fail(Fault::outOfRange, "The lens's drive has a value that is not a number; plan or calibrate again.");
    if (!(rate >= 1.0_Hz && rate <= 1000.0_Hz))
        return fail(Fault::outOfRange, "The simulated lens plays waves of 1 to 1000 Hz; choose a rate in between.");
    const Extremes ends = extremes(drive);
    const double peak = std::max(std::abs(ends.low), std::abs(ends.high));
    if (!(peak <= limits.peak * kRounding)) {
        return fail(Fault::outOfRange, "The drive reaches " + millivolts(peak) + ", more than the lens's " +
                                           millivolts(limits.peak) + "; ask for a narrower sweep.");
    }
    if (!(drive.rms() <= limits.rms * kRounding)) {
        return fail(Fault::outOfRange, "The drive would warm the lens with " + millivolts(drive.rms()) +
                                           " rms, more than the " + millivolts(limits.rms) +
                                           " it may have; ask for a narrower sweep.");
    }
    return {};
}

Result<LensRecord> recorded(LensEmulator& lens, const Harmonics& drive, Hertz rate, const RecordOptions& options) {
    if (options.samples < 1 || options.periods < 1 || !(options.noise_D >= 0.0) || !isFinite(options.settle))
        return fail(Fault::outOfRange, "A record needs at least one sample, one period and no negative noise.");
    if (auto fine = playable(drive, rate, lens.limits()); !fine) return tl::unexpected(fine.error());
    LensRecord record;
    record.family = drive.c.size() <= 2 ? "sine" : "multisine";
    record.rate = rate;
    record.drive = drive;
    record.periodsAveraged = options.periods;
    record.noise_D = options.noise_D / std::sqrt(static_cast<double>(options.periods));

    lens.play(drive, rate);
    lens.warmUp();
    // Whole periods, so that sample 0 is at x = 0 of the drive.
    const double period = 1.0 / rate.si();
    const double settle = std::ceil(std::max(0.0, options.settle.si()) / period - 1e-9) * period;
    lens.advance(Second::fromSi(settle));
    const auto samples = static_cast<std::size_t>(options.samples);
    record.power_D.assign(samples, 0.0);
    const Second interval = Second::fromSi(period / options.samples);
    for (int p = 0; p < options.periods; ++p) {
        for (double& power : record.power_D) {
            power += lens.power().si() / options.periods;
            lens.advance(interval);
        }
    }
    record.temperature_C = lens.temperature_C();
    if (record.noise_D > 0.0) {
        std::mt19937_64 random(options.seed);
        std::normal_distribution<double> noise(0.0, record.noise_D);
        for (double& power : record.power_D)
            power += noise(random);
    }
    return record;
}

RecordLens recorder(LensEmulator& lens, RecordOptions options) {
    return [&lens, options](const Harmonics& drive, Hertz rate) mutable {
        ++options.seed;
        return recorded(lens, drive, rate, options);
    };
}

}  // namespace ilf::devices
