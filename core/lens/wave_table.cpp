#include "core/lens/wave_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <tuple>

#include "core/lens/sine_record.h"

namespace ilf {
namespace {

struct Moments {
    double mean = 0.0, variance = 0.0;
};
/// Of the power over a slot, in closed form.
Moments moments(const Harmonics& power, double centre, double length) {
    const double mean = power.meanOver(centre - 0.5 * length, length);
    return {mean, squared(lessConstant(power, mean)).meanOver(centre - 0.5 * length, length)};
}

double squareError(const Moments& slot, double shift, double target) {
    const double off = slot.mean + shift - target;
    return off * off + slot.variance;
}

double peak(const TableWave& wave) { return std::max(std::abs(wave.driveLow), std::abs(wave.driveHigh)); }

long rounded_mD(double range_D) { return std::lround(range_D * 1e3); }

/// What decides between waves that are otherwise equal: a total order, so that a database always gives the same wave.
auto tieBreak(const TableWave& wave, std::size_t index) { return std::tuple(peak(wave), wave.id, index); }

}  // namespace

Result<WaveTable> waveTable(std::span<const LensRecord> records, double drift_D_per_C, double slotLength) {
    if (records.empty()) {
        return fail(Fault::notFound,
                    "There are no recorded waves to choose from: record or import some for this rate first.");
    }
    WaveTable table;
    table.rate = records.front().rate;
    table.slotLength = slotLength;
    std::vector<SineRecord> sines;
    for (const LensRecord& record : records) {
        auto sine = sineRecord(record, table.rate);
        if (!sine) return tl::unexpected(sine.error());
        sines.push_back(*std::move(sine));
    }
    const Warmth room = warmth(sines);
    table.temperature_C = room.resting_C;
    struct Judged {
        TableWave wave;
        Extremes extremes;
    };
    std::vector<Judged> judged;
    judged.reserve(sines.size());
    for (std::size_t i = 0; i < sines.size(); ++i) {
        SineRecord& sine = sines[i];
        Harmonics power = lessConstant(std::move(sine.power), drift_D_per_C * room.warmerThanThat_C[i]);
        const Extremes e = extremes(power);
        judged.push_back({{records[i].id, sine.offset - sine.amplitude, sine.offset + sine.amplitude, std::move(power),
                           sine.temperature_C},
                          e});
    }
    std::ranges::stable_sort(judged, {}, [](const Judged& j) { return j.extremes.high - j.extremes.low; });
    for (auto& [wave, e] : judged) {
        table.low_D.push_back(e.low);
        table.high_D.push_back(e.high);
        for (auto [slots, centre] : {std::pair(&table.atLow, e.atLow), std::pair(&table.atHigh, e.atHigh)}) {
            const Moments slot = moments(wave.power, centre, slotLength);
            slots->centre.push_back(centre);
            slots->mean.push_back(slot.mean);
            slots->variance.push_back(slot.variance);
        }
        table.waves.push_back(std::move(wave));
    }
    return table;
}

double slotError(const WaveTable& table, std::size_t index, double low, double high, double shift, double slotLength) {
    if (slotLength == table.slotLength) {
        return squareError({table.atLow.mean[index], table.atLow.variance[index]}, shift, low) +
               squareError({table.atHigh.mean[index], table.atHigh.variance[index]}, shift, high);
    }
    const Harmonics& power = table.waves[index].power;
    return squareError(moments(power, table.atLow.centre[index], slotLength), shift, low) +
           squareError(moments(power, table.atHigh.centre[index], slotLength), shift, high);
}

bool playable(const WaveTable& table, std::size_t index, double shift, const DriveLimits& limits) {
    const TableWave& wave = table.waves[index];
    const double middle = 0.5 * (wave.driveLow + wave.driveHigh), swing = 0.5 * (wave.driveHigh - wave.driveLow);
    return table.low_D[index] + shift >= limits.lensMin.si() && table.high_D[index] + shift <= limits.lensMax.si() &&
           peak(wave) <= limits.peak && std::sqrt(middle * middle + 0.5 * swing * swing) <= limits.rms;
}

std::optional<std::size_t> narrowestCovering(const WaveTable& table, double low, double high, double shift,
                                             double slotLength, const DriveLimits* limits) {
    const auto serves = [&](std::size_t i) {
        return table.low_D[i] + shift <= low && table.high_D[i] + shift >= high &&
               (limits == nullptr || playable(table, i, shift, *limits));
    };
    // Ranges are taken without the shift: added to both ends it would change their last bits, and so what rounds alike.
    const auto range = [&](std::size_t i) { return table.high_D[i] - table.low_D[i]; };
    const std::size_t count = table.waves.size();
    // Waves narrower than what is asked for, by more than rounding, are stepped over.
    const auto indices = std::views::iota(std::size_t{0}, count);
    const auto narrower = [&](std::size_t w) { return range(w) < high - low - 1e-9; };
    auto i = static_cast<std::size_t>(std::ranges::partition_point(indices, narrower) - indices.begin());
    while (i < count && !serves(i))
        ++i;
    if (i == count) return std::nullopt;

    // Rounding keeps order, so waves with the least rounded range follow at once.
    const long least = rounded_mD(range(i));
    std::size_t best = i;
    std::optional<double> bestError;  // judged when a second wave ties
    const auto error = [&](std::size_t w) { return slotError(table, w, low, high, shift, slotLength); };
    for (++i; i < count && rounded_mD(range(i)) == least; ++i) {
        if (!serves(i)) continue;
        if (!bestError) bestError = error(best);
        const double its = error(i);
        if (std::tuple(its, tieBreak(table.waves[i], i)) < std::tuple(*bestError, tieBreak(table.waves[best], best))) {
            best = i;
            bestError = its;
        }
    }
    return best;
}

std::optional<std::size_t> leastSlotError(const WaveTable& table, double low, double high, double shift,
                                          double slotLength, const DriveLimits* limits) {
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < table.waves.size(); ++i) {
        if (!((std::abs(table.low_D[i] + shift - low) <= kNear_D) &
              (std::abs(table.high_D[i] + shift - high) <= kNear_D)))
            continue;
        const double error = slotError(table, i, low, high, shift, slotLength);
        if (error > least || (limits != nullptr && !playable(table, i, shift, *limits))) continue;
        if (best && error == least && tieBreak(table.waves[*best], *best) < tieBreak(table.waves[i], i)) continue;
        least = error;
        best = i;
    }
    return best;
}

}  // namespace ilf
