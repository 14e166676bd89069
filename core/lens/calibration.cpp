#include "core/lens/calibration.h"

#include <algorithm>
#include <cmath>

#include "core/lens/sine_record.h"

namespace ilf {
namespace {

/// A shaped wave serves a level when it holds the lens this near to it.
constexpr double kSameLevel_D = 0.02;

WaveChoice none(std::string why, double reachable_D) {
    return {std::nullopt, std::move(why), Dioptre::fromSi(reachable_D)};
}

std::string range(const WaveWish& wish) { return shortly(wish.low.si()) + " to " + shortly(wish.high.si()) + " D"; }
std::string atRate(const WaveWish& wish) { return " at " + shortly(wish.rate.si()) + " Hz"; }

/// Of the entries of the wish's rate the one recorded nearest to the lens's temperature now.
template <class Entry>
const Entry* entryFor(const std::vector<Entry>& entries, const WaveWish& wish, double temperature_C) {
    const Entry* best = nullptr;
    const auto away = [&](const Entry& entry) { return std::abs(entry.temperature_C - temperature_C); };
    for (const Entry& entry : entries) {
        if (sameRate(entry.rate, wish.rate) && (best == nullptr || away(entry) < away(*best))) best = &entry;
    }
    return best;
}

template <class Entry>
WaveChoice neverRecorded(const std::vector<Entry>& entries, const WaveWish& wish, const std::string& what) {
    std::string rates;
    for (const Entry& entry : entries)
        rates += (rates.empty() ? "" : ", ") + shortly(entry.rate.si()) + " Hz";
    return none("There " + what + atRate(wish) + ": record the lens at this rate" +
                    (rates.empty() ? "." : ", or sweep at one that was recorded (" + rates + ")."),
                wish.low.si());
}

/// What the lens is asked to stay within; empty when it does.
std::string beyondLimits(const LensCalibration& lens, const Waveform& wave, const Extremes& power) {
    const Extremes drive = extremes(wave.drive);
    const DriveLimits& limits = lens.limits;
    const std::string unit = " " + std::string(word(wave.unit));
    if (power.low < limits.lensMin.si() || power.high > limits.lensMax.si()) {
        return "The lens would run from " + shortly(power.low) + " to " + shortly(power.high) + " D, beyond its " +
               shortly(limits.lensMin.si()) + " to " + shortly(limits.lensMax.si()) + " D";
    }
    if (wave.drive.c.empty()) return {};
    const double peak = std::max(std::abs(drive.low), std::abs(drive.high));
    if (peak > limits.peak)
        return "The drive would reach " + shortly(peak) + unit + ", above the limit of " + shortly(limits.peak) + unit;
    if (wave.drive.rms() > limits.rms) {
        return "The drive's rms would be " + shortly(wave.drive.rms()) + unit + ", above the limit of " +
               shortly(limits.rms) + unit;
    }
    return {};
}

Harmonics sine(const SineDrive& drive) {
    Harmonics u{{drive.offset}};
    if (drive.amplitude != 0.0) u.c.emplace_back(0.0, -drive.amplitude);
    return u;
}

/// Power and drive as the lens is asked to play them: delayed together so that what is at `from` falls on `lowAt`.
Waveform asWished(const WaveWish& wish, WaveMode mode, const Harmonics& power, const Harmonics& drive, double from) {
    Waveform wave;
    wave.mode = mode;
    wave.rest = wish.rest;
    wave.low = wish.low;
    wave.high = wish.high;
    wave.rate = wish.rate;
    wave.power = power.delayed(wish.lowAt - from);
    wave.drive = drive.delayed(wish.lowAt - from);
    return wave;
}

/// The x of a sine's wave that is to fall on `lowAt`. Slots lie on a grid, and the highest power need not lie a whole
/// number of them behind the lowest: each extreme gets half of what is over.
double lowSlotIn(const Extremes& e, const WaveWish& wish) {
    const double apart = e.atHigh - e.atLow;
    if (!(wish.slotLength > 0.0)) return e.atLow;
    return e.atLow + 0.5 * (apart - wish.slotLength * std::round(apart / wish.slotLength));
}

/// The largest high for which a recorded wave is chosen, all else equal; none when no wave has this low.
std::optional<double> reachableFromTable(const WaveTable& table, const LensCalibration& lens, WaveMode mode, double low,
                                         double shift) {
    std::optional<double> reach;
    for (std::size_t i = 0; i < table.waves.size(); ++i) {
        const double itsLow = table.low_D[i] + shift, itsHigh = table.high_D[i] + shift;
        const bool serves = mode == WaveMode::paper ? itsLow <= low : std::abs(itsLow - low) <= kNear_D;
        if (serves && itsHigh > reach.value_or(low) && playable(table, i, shift, lens.limits)) reach = itsHigh;
    }
    // Less a billionth, so that what is called reachable is not lost to rounding.
    if (reach && mode == WaveMode::slotAware) reach = std::min(*reach + kNear_D - 1e-9, lens.limits.lensMax.si());
    return reach;
}

WaveChoice fromTable(const LensCalibration& lens, WaveMode mode, const WaveWish& wish) {
    const WaveTable* table = entryFor(lens.tables, wish, lens.temperature_C);
    if (table == nullptr) return neverRecorded(lens.tables, wish, "are no recorded waves");
    const double low = wish.low.si(), high = wish.high.si();
    const double shift = lens.drift_D_per_C * (lens.temperature_C - table->temperature_C);
    const auto choose = mode == WaveMode::paper ? narrowestCovering : leastSlotError;
    const auto reach = reachableFromTable(*table, lens, mode, low, shift);
    const auto index = choose(*table, low, high, shift, wish.slotLength, &lens.limits);
    if (!index) {
        const std::string does = mode == WaveMode::paper ? " covers " : " comes within 0.6 D of ";
        std::string why = "None of the " + std::to_string(table->waves.size()) + " recorded waves" + atRate(wish) +
                          does + range(wish) + " within the lens's limits";
        why += reach && *reach >= high
                   ? ": none of them lies near it; record more waves, or choose the continuous mode."
               : reach ? ": the largest high power is " + shortly(*reach) + " D; bring it down, or record larger waves."
                       : ": none has so low a lowest power; record waves about a lower mean.";
        return none(std::move(why), reach.value_or(low));
    }
    const TableWave& chosen = table->waves[*index];
    const Harmonics power = lessConstant(chosen.power, -shift);
    const SineDrive drive{0.5 * (chosen.driveLow + chosen.driveHigh), 0.5 * (chosen.driveHigh - chosen.driveLow)};
    const Extremes e{table->low_D[*index] + shift, table->high_D[*index] + shift, table->atLow.centre[*index],
                     table->atHigh.centre[*index]};
    WaveChoice choice{asWished(wish, mode, power, sine(drive), lowSlotIn(e, wish)), {}, Dioptre::fromSi(*reach)};
    choice.wave->unit = lens.unit;
    choice.wave->wave = chosen.id;
    choice.wave->provenance = lens.provenance;
    return choice;
}

WaveChoice fromModel(const LensCalibration& lens, const WaveWish& wish) {
    const ContinuousModel* model = entryFor(lens.models, wish, lens.temperature_C);
    if (model == nullptr) return neverRecorded(lens.models, wish, "is no model of the lens");
    const double low = wish.low.si(), high = wish.high.si();
    const double shift = lens.drift_D_per_C * (lens.temperature_C - model->temperature_C);
    const auto drivenTo = [&](double upTo) { return inverted(*model, low, upTo, shift, wish.slotLength); };
    const auto wave = [&](const Inverted& found) {
        Waveform made =
            asWished(wish, WaveMode::continuous, found.power, sine(found.drive), lowSlotIn(found.extremes, wish));
        made.unit = model->unit;
        made.provenance = model->provenance;
        return made;
    };
    const auto allowed = [&](double upTo) {
        const auto found = drivenTo(upTo);
        return found && beyondLimits(lens, wave(*found), found->extremes).empty();
    };

    const double recorded = largestHigh(*model, low, shift, wish.slotLength);
    double reach = std::min(recorded, lens.limits.lensMax.si());
    // Drives grow with the swing; where the last one is too large the limit lies in between.
    if (reach > low && !allowed(reach - 1e-9)) {
        double inside = low;
        for (double outside = reach; outside - inside > 5e-4;) {
            const double middle = 0.5 * (inside + outside);
            (allowed(middle) ? inside : outside) = middle;
        }
        reach = inside;
    }

    const auto found = drivenTo(high);
    const std::string help = ": the largest high power is " + shortly(reach) + " D; bring it down";
    if (!found) {
        return none("The lens was not recorded as far as " + range(wish) + atRate(wish) + help +
                        ", or record waves of a larger drive.",
                    reach);
    }
    const Waveform made = wave(*found);
    const std::string beyond = beyondLimits(lens, made, found->extremes);
    if (!beyond.empty()) return none(beyond + help + ".", reach);
    return {made, {}, Dioptre::fromSi(std::max(reach, high))};
}

/// Whether the wave holds the lens at exactly these levels.
bool holds(const ShapedWave& shaped, const std::vector<Dioptre>& levels, double shift) {
    const auto near = [&](const Hold& hold, Dioptre level) {
        return std::abs(hold.power_D + shift - level.si()) <= kSameLevel_D;
    };
    const auto isLevel = [&](const Hold& hold) {
        return std::ranges::any_of(levels, [&](Dioptre level) { return near(hold, level); });
    };
    const auto isHeld = [&](Dioptre level) {
        return std::ranges::any_of(shaped.holds, [&](const Hold& hold) { return near(hold, level); });
    };
    return std::ranges::all_of(shaped.holds, isLevel) && std::ranges::all_of(levels, isHeld);
}

WaveChoice fromShaped(const LensCalibration& lens, const WaveWish& wish) {
    std::vector<Dioptre> levels = wish.levels;
    if (levels.empty()) levels = {wish.low, wish.high};
    std::string asked;
    for (const Dioptre level : levels)
        asked += (asked.empty() ? "" : ", ") + shortly(level.si());
    bool colder = false;
    // The newest is the last: learning again replaces what was learnt before.
    for (auto shaped = lens.shaped.rbegin(); shaped != lens.shaped.rend(); ++shaped) {
        if (!sameRate(shaped->rate, wish.rate)) continue;
        const double shift = lens.drift_D_per_C * (lens.temperature_C - shaped->temperature_C);
        if (!holds(*shaped, levels, shift)) {
            colder = colder || holds(*shaped, levels, 0.0);
            continue;
        }
        // Its lowest power may lie anywhere in the hold of the lowest level; the hold is what slots are laid on.
        const auto lowest = std::ranges::min_element(shaped->holds, {}, &Hold::power_D);
        Waveform wave =
            asWished(wish, WaveMode::shaped, lessConstant(shaped->power, -shift), shaped->drive, lowest->centre);
        wave.unit = shaped->unit;
        wave.wave = shaped->id;
        wave.provenance = shaped->provenance;
        const std::string beyond = beyondLimits(lens, wave, extremes(wave.power));
        if (!beyond.empty()) return none(beyond + ": learn it again with less swing.", wish.high.si());
        return {wave, {}, wish.high};
    }
    if (colder) {
        return none("The lens is at " + shortly(lens.temperature_C) + " degrees C now, and the shaped wave for " +
                        asked + " D was learnt at another temperature: learn it again.",
                    wish.high.si());
    }
    return none("No shaped wave for " + asked + " D" + atRate(wish) +
                    " has been learnt: learn one, or choose the continuous mode.",
                wish.high.si());
}

}  // namespace

WaveChoice chosenWave(const LensCalibration& lens, WaveMode mode, const WaveWish& wish) {
    const bool numbers = isFinite(wish.low) && isFinite(wish.high) && isFinite(wish.rate);
    if (!numbers || wish.low > wish.high || !(wish.rate > 0.0_Hz)) {
        return none("A sweep needs a lowest power, a highest power that is not lower, and a rate above 0 Hz.",
                    wish.low.si());
    }
    const Dioptre least = lens.limits.lensMin, most = lens.limits.lensMax;
    if (wish.low < least || wish.high > most) {
        WaveWish allowed = wish;
        allowed.low = std::clamp(wish.low, least, most);
        allowed.high = allowed.low;
        const Dioptre reach = wish.low < least ? wish.low : chosenWave(lens, mode, allowed).reachable;
        return none("A sweep of " + range(wish) + " is beyond the lens's " + shortly(least.si()) + " to " +
                        shortly(most.si()) + " D: move the object that asks for it farther away.",
                    reach.si());
    }
    WaveChoice choice;
    switch (mode) {
    case WaveMode::idealSine:
        choice = {idealSine(wish.rest, wish.low, wish.high, wish.rate, wish.lowAt / wish.rate), {}, most};
        break;
    case WaveMode::paper:
    case WaveMode::slotAware:
        choice = fromTable(lens, mode, wish);
        break;
    case WaveMode::continuous:
        choice = fromModel(lens, wish);
        break;
    case WaveMode::shaped:
        choice = fromShaped(lens, wish);
        break;
    }
    if (wish.low == wish.high) {
        // A still lens needs no record: its driver knows how to hold a power.
        choice.why.clear();
        choice.wave = stillWave(wish.rest, wish.low, wish.rate);
        choice.wave->mode = mode;
        choice.wave->unit = lens.unit;
        choice.wave->provenance = lens.provenance;
    }
    if (choice.wave) {
        const double rms = choice.wave->drive.rms();
        choice.wave->temperature_C = lens.temperature_C;
        choice.wave->warming_C = lens.warming_C_per_square * rms * rms;
    }
    return choice;
}

}  // namespace ilf
