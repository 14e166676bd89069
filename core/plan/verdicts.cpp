#include "core/plan/verdicts.h"

#include <algorithm>
#include <cmath>

#include "core/plan/projector.h"
#include "core/plan/words.h"

namespace ilf {
namespace {

Result<void> checkedRates(const Rig& rig) {
    if (!isFinite(rig.sweepRate) || rig.sweepRate <= 0.0_Hz || !isFinite(rig.slotRate) || rig.slotRate <= 0.0_Hz) {
        return fail(Fault::outOfRange, "Sweep rate and slot rate must be more than 0 Hz.");
    }
    const double ratio = rig.slotRate / rig.sweepRate;
    const double whole = std::max(2.0, std::min(std::round(ratio), static_cast<double>(mostSlots(rig))));
    if (std::abs(ratio - std::round(ratio)) > 1e-9 * ratio || ratio < 1.5) {
        const Beat beat = slowestBeat(rig.slotRate, rig.sweepRate);
        const std::string flicker = beat.modulation > 0.0
                                        ? "the light would flicker at " + inWords(beat.frequency.si(), 1) + " Hz by " +
                                              inWords(100.0 * beat.modulation, 1) +
                                              " %, and no component below the "
                                              "sweep may exceed 0.5 %"
                                        : "a sweep needs two slots at least";
        return fail(Fault::unsafe, "The slot rate, " + inWords(rig.slotRate.si(), 1) +
                                       " Hz, is no whole multiple of the sweep rate, " +
                                       inWords(rig.sweepRate.si(), 1) + " Hz: " + flicker + ". Use a slot rate of " +
                                       inWords(rig.sweepRate.si() * whole, 1) +
                                       " Hz, or for a projector of fixed rate a sweep of " +
                                       inWords(rig.slotRate.si() / whole, 1) + " Hz.");
    }
    return checkedProjector(rig);
}

std::string lensReach(const Rig& rig) {
    return "the lens reaches " + inWords(rig.lensMin) + " to " + inWords(rig.lensMax);
}

void cannotFocus(RegionPlan& region, std::string why, std::string help) {
    region.problem = inQuotes(region.name) + " cannot be seen sharp" + why;
    region.help = std::move(help);
}

/// Says why there is no power that shows all of the object sharp.
void explainNoFocus(const PlanInput& input, const PlanObject& object, RegionPlan& region) {
    const PowerWindow nearest = inFocusWindow(input.eye, object.nearest);
    const PowerWindow farthest = inFocusWindow(input.eye, object.farthest);
    if (!farBorderOffset(input.eye).reachesLens) {
        return cannotFocus(region, ": the wearer's far point lies between lens and eye.",
                           "Check the prescription and the distance from lens to pupil.");
    }
    if (nearest.low > farthest.high) {
        return cannotFocus(region,
                           " as a whole: it reaches from " + inWords(object.nearest) + " to " +
                               inWords(object.farthest) + ", deeper than the depth of focus.",
                           "Split it into regions of less depth, move it away, or allow a larger circle of confusion.");
    }
    if (nearest.low > input.rig.lensMax) {
        const Dioptre reach = input.rig.lensMax - nearBorderOffset(input.eye).power;
        return cannotFocus(region, ": it would take " + inWords(nearest.low) + ", and " + lensReach(input.rig) + ".",
                           "Move it beyond " + inWordsRoundedUp(1.0 / reach) + ".");
    }
    cannotFocus(region, ": it would take " + inWords(farthest.high) + ", and " + lensReach(input.rig) + ".",
                "Move it nearer, or correct the wearer's prescription otherwise.");
}

std::size_t nearestPower(const std::vector<Dioptre>& powers, Dioptre to) {
    return static_cast<std::size_t>(
        std::ranges::min_element(powers, {}, [&](Dioptre power) { return abs(power - to); }) - powers.begin());
}

}  // namespace

Dioptre restOf(const PlanInput& input) { return input.camera ? 0.0_D : restPower(input.eye); }

Result<void> checkedInput(const PlanInput& input) {
    for (const PlanObject& object : input.objects) {
        if (!isFinite(object.nearest) || !isFinite(object.farthest) || object.nearest <= 0.0_m ||
            object.farthest < object.nearest) {
            return fail(Fault::outOfRange, "The distance of " + inQuotes(object.name) +
                                               " must be more than 0 m, counted from the wearer's lens.");
        }
        if (object.strength && (!isFinite(*object.strength) || *object.strength <= 0.0_D)) {
            return fail(Fault::outOfRange, "The blur strength of " + inQuotes(object.name) + " must be more than 0 D.");
        }
    }
    if (!isFinite(input.alpha) || input.alpha < 0.0_D) {
        return fail(Fault::outOfRange, "Alpha, the margin above P_s, must be 0 D or more.");
    }
    const EyeOptics& eye = input.eye;
    const bool positive = eye.pupil > 0.0_m && eye.retina > 0.0_m && eye.confusion > 0.0_m &&
                          eye.lensToPupil >= 0.0_m && eye.accommodation >= 0.0_D;
    if (!positive || !isFinite(eye.pupil) || !isFinite(eye.retina) || !isFinite(eye.confusion) ||
        !isFinite(eye.lensToPupil) || !isFinite(eye.accommodation) || !isFinite(eye.ametropia)) {
        return fail(Fault::outOfRange, "Pupil, eye power, circle of confusion, distance from lens to pupil and "
                                       "accommodation must be positive numbers. Check the wearer.");
    }
    if (!isFinite(input.rig.powerBudget) || input.rig.powerBudget <= 0.0_D || !(input.rig.blurShare >= 0.0)) {
        return fail(Fault::outOfRange, "The power error that slots may have must be more than 0 D. Check the rig.");
    }
    if (input.rig.lensMin > 0.0_D || input.rig.lensMax < 0.0_D || !isFinite(input.rig.lensMin) ||
        !isFinite(input.rig.lensMax)) {
        return fail(Fault::outOfRange, "The lens's range of powers must include 0 D. Check the rig.");
    }
    if (input.rig.lensMax * eye.lensToPupil >= 1.0) {
        return fail(Fault::unsafe,
                    "At its strongest the lens would focus in front of the pupil. Lower the lens's upper "
                    "limit or the distance from lens to pupil.");
    }
    if (const auto rates = checkedRates(input.rig); !rates) return rates;
    const Dioptre rest = restOf(input);
    if (rest < input.rig.lensMin || rest > input.rig.lensMax) {
        return fail(Fault::unsafe, "The wearer's prescription needs the lens at " + inWords(rest) + ", and " +
                                       lensReach(input.rig) + ". Correct part of it with glasses.");
    }
    return {};
}

FocusVerdict focusVerdict(const PlanInput& input, std::vector<RegionPlan>& regions) {
    std::vector<FocusWindow> windows;
    std::vector<std::size_t> objectOfWindow;
    std::vector<std::size_t> failing;
    for (std::size_t i = 0; i < input.objects.size(); ++i) {
        if (input.objects[i].look != Look::focus) continue;
        const FocusWindow window = focusWindow(input, input.objects[i]);
        if (window.open()) {
            windows.push_back(window);
            objectOfWindow.push_back(i);
        } else {
            explainNoFocus(input, input.objects[i], regions[i]);
            failing.push_back(i);
        }
    }
    const Dioptre rest = restOf(input);
    FocusLevels levels = focusLevels(windows, rest, input.camera);
    FocusVerdict verdict{std::move(levels.powers), std::vector<std::size_t>(input.objects.size(), 0), 0};
    for (std::size_t w = 0; w < windows.size(); ++w)
        verdict.ofObject[objectOfWindow[w]] = levels.ofWindow[w];
    if (verdict.powers.empty()) verdict.powers.push_back(rest);
    for (const std::size_t i : failing) {
        verdict.ofObject[i] = nearestPower(verdict.powers, focusWindow(input, input.objects[i]).centre);
    }
    verdict.main = nearestPower(verdict.powers, rest);
    return verdict;
}

BlurWish blurWish(const PlanInput& input, const PlanObject& object, Dioptre focusPower, RegionPlan& region) {
    const auto pMin = minimumBlurPower(input.eye, object.nearest);
    region.alreadyBlurred = !pMin || *pMin < focusPower;
    if (!pMin) return {};
    region.pMin = *pMin;
    const Dioptre margin = std::max(input.alpha, object.strength.value_or(0.0_D));
    if (region.alreadyBlurred && (!object.strength || *pMin + *object.strength <= focusPower)) return {};
    // Without a strength alpha may give way, down to nothing.
    const bool reaches = object.strength ? *pMin + margin <= input.rig.lensMax : *pMin < input.rig.lensMax;
    if (!reaches) {
        if (region.alreadyBlurred) return {};
        const Dioptre needed = object.strength ? margin : 0.0_D;
        const Dioptre room = input.rig.lensMax - needed - farBorderOffset(input.eye).power;
        region.problem = inQuotes(object.name) + " cannot be blurred at " + inWords(object.nearest) +
                         ": it would take " + inWords(*pMin + needed) + ", and " + lensReach(input.rig) + ".";
        region.help = room > 0.0_D ? "Move it beyond " + inWordsRoundedUp(1.0 / room) + "." : "Lower alpha.";
        if (object.strength && *object.strength > input.alpha && *pMin + input.alpha <= input.rig.lensMax) {
            region.help += " Or lower its strength to " + inWords(input.rig.lensMax - *pMin) + ".";
        }
        return {};
    }
    BlurWish wish{true, std::nullopt};
    if (object.strength) wish.power = *pMin + *object.strength;
    return wish;
}

}  // namespace ilf
