#include "core/lens/drive_range.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/lens/sine_record.h"

namespace ilf {
namespace {

/// Good enough for a border: the range asked for has a margin anyway.
constexpr double kNearEnough_D = 0.05;
constexpr int kMostSteps = 6;
/// No step multiplies what was tried by more than this, so that a resonance or a stiff spring is met gently.
constexpr double kBoldest = 2.5;

/// Secant steps to where `measured` is `wanted`, within +-`most`; the nearest it came where that lies outside.
Result<double> found(const std::function<Result<double>(double)>& measured, double wanted, double first, double most) {
    double before = 0.0, here = first;
    auto atBefore = measured(before);
    if (!atBefore) return atBefore;
    for (int step = 0; step < kMostSteps; ++step) {
        const auto atHere = measured(here);
        if (!atHere) return atHere;
        if (std::abs(*atHere - wanted) < kNearEnough_D) break;
        const double slope = (*atHere - *atBefore) / (here - before);
        if (!(slope > 0.0)) {
            return fail(Fault::device, "The lens's power does not grow with its drive (" + shortly(*atHere) + " D at " +
                                           shortly(here) + "): check its cable and its polarity.");
        }
        const double reach = kBoldest * std::max(std::abs(here), std::abs(first));
        const double next =
            std::clamp(here + (wanted - *atHere) / slope, -std::min(reach, most), std::min(reach, most));
        if (next == here) break;
        before = here;
        atBefore = atHere;
        here = next;
    }
    return here;
}

}  // namespace

Harmonics sineDrive(const SineDrive& drive) {
    Harmonics u{{drive.offset}};
    if (drive.amplitude != 0.0) u.c.emplace_back(0.0, -drive.amplitude);
    return u;
}

Result<DriveRange> driveRange(const RecordLens& record, Hertz rate, double powerLow_D, double powerHigh_D,
                              const DriveLimits& limits) {
    if (!(powerLow_D < powerHigh_D) || !(limits.peak > 0.0) || !(limits.rms > 0.0)) {
        return fail(Fault::outOfRange,
                    "To record a lens, state a lowest and a higher power and the limits of its drive.");
    }
    const auto asked = [&](const SineDrive& drive) -> Result<Harmonics> {
        const auto made = record(sineDrive(drive), rate);
        if (!made) return tl::unexpected(made.error());
        auto sine = sineRecord(*made, rate);
        if (!sine) return tl::unexpected(sine.error());
        return std::move(sine->power);
    };
    const double small = limits.peak / 50.0, most = std::min(limits.peak, limits.rms);
    const auto steady = [&](double offset) -> Result<double> {
        return asked({offset, 0.0}).map([](const Harmonics& power) { return power.mean(); });
    };
    DriveRange range;
    for (auto [wanted, drive] : {std::pair(powerLow_D, &range.low), std::pair(powerHigh_D, &range.high)}) {
        const auto offset = found(steady, wanted, small, most);
        if (!offset) return tl::unexpected(offset.error());
        *drive = *offset;
    }
    if (!(range.low < range.high)) {
        return fail(Fault::device, "The lens does not reach from " + shortly(powerLow_D) + " to " +
                                       shortly(powerHigh_D) + " D within the limits of its drive: check both.");
    }
    const double middle = 0.5 * (range.low + range.high);
    const double room = std::min(limits.peak - std::abs(middle),
                                 std::sqrt(std::max(0.0, 2.0 * (limits.rms * limits.rms - middle * middle))));
    const auto swing = [&](double amplitude) -> Result<double> {
        if (amplitude == 0.0) return 0.0;
        return asked({middle, amplitude}).map([](const Harmonics& power) {
            const Extremes e = extremes(power);
            return e.high - e.low;
        });
    };
    const auto amplitude = found(swing, powerHigh_D - powerLow_D, std::min(small, room), room);
    if (!amplitude) return tl::unexpected(amplitude.error());
    range.largestAmplitude = *amplitude;
    return range;
}

Result<std::vector<LensRecord>> recordedRange(const RecordLens& record, Hertz rate, const DriveRange& range,
                                              std::size_t count) {
    std::vector<LensRecord> records;
    for (const SineDrive& drive : drivesToRecord(range.low, range.high, count, range.largestAmplitude)) {
        auto made = record(sineDrive(drive), rate);
        if (!made) return tl::unexpected(made.error());
        made->family = "sine";
        records.push_back(*std::move(made));
    }
    return records;
}

}  // namespace ilf
