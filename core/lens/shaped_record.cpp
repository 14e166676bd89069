#include "core/lens/shaped_record.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace ilf {

double peakOf(const Harmonics& f) {
    const Extremes e = extremes(f);
    return std::max(std::abs(e.low), std::abs(e.high));
}

Result<RecordedPower> recordedPower(const RecordLens& record, const Harmonics& drive, Hertz rate, int harmonics,
                                    const DriveLimits& limits) {
    // Designs touch their limits; rounding may carry them a hair beyond.
    const double peak = peakOf(drive), rms = drive.rms();
    if (peak > limits.peak * (1.0 + 1e-9) || rms > limits.rms * (1.0 + 1e-9))
        return fail(Fault::unsafe, "A wave to be recorded would drive the lens with " + std::to_string(peak) +
                                       " peak and " + std::to_string(rms) + " rms; its limits are " +
                                       std::to_string(limits.peak) + " and " + std::to_string(limits.rms) + ".");
    Result<LensRecord> got = record(drive, rate);
    if (!got) return tl::unexpected(got.error());
    const std::size_t samples = got->power_D.size();
    if (samples < 4 * static_cast<std::size_t>(harmonics) + 4)
        return fail(Fault::device, "A record of the lens has " + std::to_string(samples) + " samples; " +
                                       std::to_string(harmonics) + " harmonics need at least " +
                                       std::to_string(4 * harmonics + 4) + ".");
    if (!std::ranges::all_of(got->power_D, [](double p) { return std::isfinite(p); }))
        return fail(Fault::device,
                    "A record of the lens holds samples that are no numbers; check the photodiode and record again.");
    RecordedPower out;
    out.power = harmonicsOf(got->power_D, std::min<std::size_t>(std::max(16, harmonics), (samples - 1) / 2));
    const double kept = static_cast<double>(2 * out.power.c.size() - 1) / static_cast<double>(samples);
    out.noise_D = got->noise_D * std::sqrt(kept);
    out.unit = got->unit;
    out.temperature_C = got->temperature_C;
    out.provenance = got->provenance;
    return out;
}

}  // namespace ilf
