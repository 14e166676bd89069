#include "app/lens/record_lens.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/lens/continuous_model.h"

namespace ilf::app {
namespace {

Harmonics sine(double offset, double amplitude) {
    return amplitude == 0.0 ? Harmonics{{offset}} : Harmonics{{offset, std::complex<double>(0.0, -amplitude)}};
}

/// What the waves of a survey are to cover: means of 2 +- 7 D, and about 2 D swings of +-4.6 D.
constexpr double kMiddle_D = 2.0, kMeans_D = 7.0, kSwing_D = 4.6;
/// The largest drive of a survey, of the lens's limit: records are noisy and so is what is drawn from them.
constexpr double kNearLimit = 0.98;

}  // namespace

devices::LensEmulator LensBench::lens() const {
    return devices::LensEmulator(devices::lensParameters(preset, seed), temperature_C);
}

Result<std::vector<LensRecord>> recordedAll(const LensBench& bench, const std::vector<Harmonics>& drives, Hertz rate) {
    const devices::LensEmulator rested = bench.lens();
    std::vector<std::optional<Result<LensRecord>>> results(drives.size());
    parallelFor(static_cast<int>(drives.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        devices::LensEmulator lens = rested;
        devices::RecordOptions options = bench.options;
        options.seed += 1000003 * (at + 1);
        results[at] = devices::recorded(lens, drives[at], rate, options);
    });
    std::vector<LensRecord> records;
    records.reserve(drives.size());
    for (auto& result : results) {
        if (!*result) return tl::unexpected(result->error());
        records.push_back(**std::move(result));
        records.back().id = static_cast<std::int64_t>(records.size());
    }
    return records;
}

Result<std::vector<LensRecord>> surveyed(const LensBench& bench, Hertz rate, std::size_t waves, Dioptre rest) {
    if (waves < 9) {
        return fail(Fault::outOfRange,
                    "A survey of the lens needs at least 9 waves, not " + std::to_string(waves) + "; 40 are usual.");
    }
    const DriveLimits limits = bench.lens().limits();
    const double step = limits.peak / 8.0, small = limits.peak / 30.0;
    auto probes = recordedAll(bench, {sine(-step, 0.0), sine(step, 0.0), sine(0.0, small)}, rate);
    if (!probes) return probes;
    const auto mean = [](const LensRecord& record) { return harmonicsOf(record.power_D, 0).mean(); };
    const double perVolt = (mean((*probes)[1]) - mean((*probes)[0])) / (2.0 * step);
    const double swingPerVolt = std::abs(harmonicsOf((*probes)[2].power_D, 1).c[1]) / small;
    const double resting = 0.5 * (mean((*probes)[1]) + mean((*probes)[0]));
    if (!(perVolt > 0.0) || !(swingPerVolt > 0.0)) {
        return fail(Fault::device, "The lens's power does not grow with its drive; check the polarity of its cable.");
    }
    const double most = kNearLimit * limits.peak;
    const auto steady = [&](double power_D) { return std::clamp((power_D - resting) / perVolt, -most, most); };
    const double middle_D = rest.si() + kMiddle_D;
    const double low = steady(middle_D - kMeans_D), high = steady(middle_D + kMeans_D);
    const double swing = std::min(kSwing_D / swingPerVolt, most - std::abs(0.5 * (low + high)));
    std::vector<Harmonics> drives;
    for (const SineDrive& drive : drivesToRecord(low, high, waves, swing)) {
        const double room = most - std::abs(drive.offset);
        drives.push_back(sine(drive.offset, std::min(drive.amplitude, std::max(room, 0.0))));
    }
    auto others = recordedAll(bench, drives, rate);
    if (!others) return others;
    for (LensRecord& record : *others) {
        record.id = static_cast<std::int64_t>(probes->size()) + 1;
        probes->push_back(std::move(record));
    }
    return probes;
}

Result<std::vector<LensRecord>> paperWaves(const LensBench& bench, Hertz rate) {
    std::vector<Harmonics> drives;
    for (int low = -35; low <= 35; ++low) {
        for (int high = low + 1; high <= 35; ++high)
            drives.push_back(sine(0.001 * (high + low), 0.001 * (high - low)));
    }
    return recordedAll(bench, drives, rate);
}

}  // namespace ilf::app
