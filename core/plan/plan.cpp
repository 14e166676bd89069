#include "core/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/plan/sweep.h"
#include "core/plan/verdicts.h"
#include "core/plan/words.h"

namespace ilf {
namespace {

/// Powers nearer than this are one power.
constexpr Dioptre kSamePower = 1e-9_D;

/// A plan while it is being made: wishes for levels, and which wish each region is lit with.
struct Draft {
    std::vector<LevelWish> wishes;
    std::vector<std::size_t> ofRegion;

    /// The level of a blurred region that asks for `power`. A level up to the error budget `merging` above it serves as
    /// well: slots could hardly tell them apart, and more power than asked still blurs.
    std::size_t blurLevel(Dioptre power, Dioptre pMin, Dioptre merging) {
        for (std::size_t l = 0; l < wishes.size(); ++l) {
            const Dioptre above = wishes[l].power - power;
            const Dioptre reach = wishes[l].kind == LevelKind::blur ? merging : kSamePower;
            if (above < -kSamePower || above > reach) continue;
            if (wishes[l].kind == LevelKind::blur) wishes[l].above = std::max(wishes[l].above.value_or(pMin), pMin);
            return l;
        }
        wishes.push_back({LevelKind::blur, power, pMin});
        return wishes.size() - 1;
    }
    std::size_t strongest() const {
        return static_cast<std::size_t>(std::ranges::max_element(wishes, {}, &LevelWish::power) - wishes.begin());
    }
    std::size_t nearest(LevelKind kind, Dioptre power, std::size_t except) const {
        std::size_t best = except;
        for (std::size_t l = 0; l < wishes.size(); ++l) {
            if (l == except || wishes[l].kind != kind) continue;
            if (best == except || abs(wishes[l].power - power) < abs(wishes[best].power - power)) best = l;
        }
        return best;
    }
    /// Ascending, each once.
    std::vector<Dioptre> powers() const {
        std::vector<Dioptre> powers;
        for (const LevelWish& wish : wishes)
            powers.push_back(wish.power);
        std::ranges::sort(powers);
        const auto same = std::ranges::unique(powers, [](Dioptre a, Dioptre b) { return b - a <= kSamePower; });
        powers.erase(same.begin(), same.end());
        return powers;
    }
    void remove(std::size_t level, std::size_t replacement) {
        for (std::size_t& l : ofRegion) {
            if (l == level) l = replacement;
            if (l > level) --l;
        }
        wishes.erase(wishes.begin() + static_cast<std::ptrdiff_t>(level));
    }
};

/// The largest P_min of the regions that need the sweep, and whose it is (the first one's, if several share it).
void findDriver(Plan& plan, const std::vector<BlurWish>& wishes) {
    for (std::size_t i = 0; i < wishes.size(); ++i) {
        const RegionPlan& region = plan.regions[i];
        if (!wishes[i].needsSweep || (plan.pS && *region.pMin <= *plan.pS)) continue;
        plan.pS = region.pMin;
        plan.driver = region.id;
    }
}

Draft drafted(const PlanInput& input, const Plan& plan, const FocusVerdict& focus, const std::vector<BlurWish>& blurs,
              Dioptre high) {
    Draft draft{{}, focus.ofObject};
    for (const Dioptre power : focus.powers)
        draft.wishes.push_back({LevelKind::focus, power, std::nullopt});

    // From the strongest down, so that a weaker wish finds the level just above it.
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < blurs.size(); ++i) {
        if (blurs[i].needsSweep) order.push_back(i);
    }
    const auto wanted = [&](std::size_t i) { return blurs[i].power.value_or(high); };
    std::ranges::stable_sort(order, std::greater{}, wanted);
    for (const std::size_t i : order)
        draft.ofRegion[i] = draft.blurLevel(wanted(i), *plan.regions[i].pMin, input.rig.powerBudget);

    for (std::size_t i = 0; i < input.objects.size(); ++i) {
        if (input.objects[i].look != Look::blur || blurs[i].needsSweep) continue;
        // Already blurred at rest, or as blurred as the sweep can make it.
        draft.ofRegion[i] = plan.regions[i].alreadyBlurred ? focus.main : draft.strongest();
    }
    return draft;
}

/// Writes down that the wave passes a level too fast.
void explainTooFast(const Draft& draft, std::size_t level, std::size_t replacement, Plan& plan) {
    const std::string at = inWords(draft.wishes[level].power), instead = inWords(draft.wishes[replacement].power);
    for (std::size_t i = 0; i < plan.regions.size(); ++i) {
        RegionPlan& region = plan.regions[i];
        if (region.look == Look::neutral || draft.ofRegion[i] != level || !region.problem.empty()) continue;
        if (region.look == Look::focus) {
            region.problem = inQuotes(region.name) + " needs light at " + at +
                             ", in the middle of the sweep, where the lens "
                             "is too fast for one slot: it is lit at " +
                             instead + " and not sharp.";
            region.help = "Put it nearer to the other focused objects, use a projector with shorter slots, or a shaped "
                          "wave that holds this level.";
        } else {
            region.problem = inQuotes(region.name) + " needs light at " + at +
                             ", in the middle of the sweep, where the lens "
                             "is too fast for one slot: it is lit at " +
                             instead + " and blurred more than asked.";
            region.help =
                "Leave its strength empty, raise it so that it is lit at the end of the sweep, or use a shaped "
                "wave that holds this level.";
        }
    }
}

tl::unexpected<Error> tooFast(const Draft& draft, std::size_t level, const Plan& plan) {
    const auto lit = std::ranges::find(draft.ofRegion, level);
    const bool named = lit != draft.ofRegion.end() && plan.input.camera;
    std::string what = "The plan needs light at ";
    if (named) {
        what = inQuotes(plan.regions[static_cast<std::size_t>(lit - draft.ofRegion.begin())].name) +
               (draft.wishes[level].kind == LevelKind::focus ? " is in focus for the camera at "
                                                             : " is to be blurred for the camera at ");
    }
    const WaveMode mode = plan.waveform.mode;
    const std::string wave = mode == WaveMode::idealSine ? "sine" : std::string(word(mode)) + " wave";
    return fail(Fault::unsafe, what + inWords(draft.wishes[level].power) + ", where a " + wave + " of " +
                                   inWords(plan.waveform.low) + " to " + inWords(plan.waveform.high) + " at " +
                                   inWords(plan.waveform.rate) + " does not stay within the error budget, " +
                                   inWords(plan.input.rig.powerBudget) +
                                   ", for even one slot. Bring the distances closer together, allow more error, or use "
                                   "a rig with shorter slots" +
                                   (plan.input.rig.waves == WaveMode::shaped ? "." : " or a shaped wave."));
}

/// Gives every level slots. Levels in the middle of the sweep that the wave cannot hold are given up in words; a
/// camera's levels and the two ends of the sweep are what the plan is for, so without them there is no plan.
Result<void> fitted(Draft& draft, SweepPlanner& sweep, Plan& plan) {
    for (;;) {
        const Schedule& schedule = sweep.schedule(draft.wishes);
        const auto empty =
            std::ranges::find_if(schedule.levels, [](const Level& level) { return level.slots.empty(); });
        if (empty == schedule.levels.end() || plan.waveform.still()) return {};
        const auto level = static_cast<std::size_t>(empty - schedule.levels.begin());
        const bool focus = draft.wishes[level].kind == LevelKind::focus;
        const std::size_t replacement =
            focus ? draft.nearest(LevelKind::focus, draft.wishes[level].power, level) : draft.strongest();
        if (plan.input.camera || replacement == level) return tooFast(draft, level, plan);
        explainTooFast(draft, level, replacement, plan);
        draft.remove(level, replacement);
    }
}

/// Focus levels first, each kind ascending.
void sortLevels(Draft& draft) {
    std::vector<std::size_t> order(draft.wishes.size());
    for (std::size_t l = 0; l < order.size(); ++l)
        order[l] = l;
    std::ranges::stable_sort(order, {}, [&](std::size_t l) {
        return std::pair(draft.wishes[l].kind == LevelKind::blur, draft.wishes[l].power);
    });
    std::vector<LevelWish> wishes;
    std::vector<std::size_t> rank(order.size());
    for (std::size_t l = 0; l < order.size(); ++l) {
        rank[order[l]] = l;
        wishes.push_back(draft.wishes[order[l]]);
    }
    draft.wishes = std::move(wishes);
    for (std::size_t& l : draft.ofRegion)
        l = rank[l];
}

/// The least of the powers a region is really lit with: the means of its level's slots.
Dioptre leastLitPower(const Plan& plan, const RegionPlan& region) {
    Dioptre least = region.levelPower;
    for (const int slot : plan.levels[static_cast<std::size_t>(*region.level)].slots) {
        least = std::min(least, plan.slots[static_cast<std::size_t>(slot)].power);
    }
    return least;
}

/// The power each region is lit with, and what that does to it.
void describeRegions(Plan& plan, const Draft& draft) {
    const EyeOptics& eye = plan.input.eye;
    std::optional<std::size_t> attended;
    for (std::size_t i = 0; i < plan.regions.size(); ++i) {
        RegionPlan& region = plan.regions[i];
        region.levelPower = plan.focusPower;
        if (region.look != Look::neutral) {
            region.level = static_cast<int>(draft.ofRegion[i]);
            region.levelPower = plan.levels[draft.ofRegion[i]].power;
        }
        if (region.look != Look::focus || !region.problem.empty()) continue;
        if (!attended || region.nearest < plan.regions[*attended].nearest) attended = i;
    }
    for (RegionPlan& region : plan.regions) {
        region.blurDiameter = blurDiameter(eye, region.nearest, region.levelPower);
        region.blurDiameterFarthest = blurDiameter(eye, region.farthest, region.levelPower);
        region.blurDiameterAttending =
            attended && !plan.input.camera
                ? blurDiameterAttending(eye, region.nearest, region.levelPower, plan.regions[*attended].nearest,
                                        plan.regions[*attended].levelPower)
                : region.blurDiameter;
        region.scale = magnification(eye, region.nearest, plan.focusPower, region.levelPower);
        if (region.look == Look::blur && region.problem.empty() && region.pMin &&
            leastLitPower(plan, region) <= *region.pMin) {
            region.problem = inQuotes(region.name) + " is lit no farther than its border of blur, " +
                             inWords(*region.pMin) + ", and may look sharp.";
            region.help = "Raise alpha.";
        }
    }
}

/// What is asked of the lens: from the lowest focus level (the lens need not pass its rest power on the way) to P_s +
/// alpha, or farther where a strength or a focus level asks for it.
Dioptre highOf(const Plan& plan, const FocusVerdict& focus, const std::vector<BlurWish>& blurs) {
    Dioptre high = focus.powers.back();
    if (plan.pS) high = std::max(high, *plan.pS + plan.alpha);
    for (const BlurWish& wish : blurs)
        high = std::max(high, wish.power.value_or(high));
    return high;
}

/// Whose wish the end of the sweep is.
std::string whoAsksFor(const Plan& plan, Dioptre high, const std::vector<BlurWish>& blurs, const FocusVerdict& focus,
                       const WaveChoice& choice) {
    const std::string reaches = "The lens reaches " + inWords(choice.reachable) + " at most here";
    for (std::size_t i = 0; i < blurs.size(); ++i) {
        if (blurs[i].power != high) continue;
        const Dioptre left = choice.reachable - *plan.regions[i].pMin;
        return reaches + ", and the strength of " + inQuotes(plan.regions[i].name) + " asks for " + inWords(high) +
               (left > 0.0_D ? ": lower it to " + inWords(left) + "." : ": lower it, or move it away.");
    }
    if (focus.powers.back() == high) {
        for (std::size_t i = 0; i < plan.regions.size(); ++i) {
            if (plan.regions[i].look != Look::focus || focus.powers[focus.ofObject[i]] != high) continue;
            return reaches + ", and " + inQuotes(plan.regions[i].name) + " is sharp at " + inWords(high) +
                   ": move it away, or do not focus it.";
        }
        return reaches + ".";
    }
    const auto driver = std::ranges::find_if(plan.regions, [&](const RegionPlan& r) { return plan.driver == r.id; });
    if (driver == plan.regions.end()) return reaches + ".";
    const Dioptre most = choice.reachable - plan.farOffset;
    return "The largest P_s this lens reaches here is " + inWords(choice.reachable) + ", and " +
           inQuotes(driver->name) + " asks for " + inWords(*plan.pS) +
           (most > 0.0_D ? ": move it beyond " + inWordsRoundedUp(1.0 / most) + "." : ".");
}

/// Chooses the wave, for less alpha than asked where lens or rig do not reach farther.
Result<Draft> swept(const FocusVerdict& focus, const std::vector<BlurWish>& blurs, SweepPlanner& sweep, Plan& plan) {
    const auto relax = [&](Dioptre reach, const std::string& why) {
        const Dioptre asked = std::exchange(plan.alpha, reach - *plan.pS);
        plan.warnings.push_back("Alpha is " + inWords(plan.alpha) + " instead of " + inWords(asked) + ": " + why +
                                " Blur is that much nearer to its border.");
    };
    const Dioptre most = plan.input.rig.lensMax;
    if (plan.pS && *plan.pS + plan.alpha > most) relax(most, "the rig's lens goes to " + inWords(most) + ".");
    for (;;) {
        const Dioptre high = highOf(plan, focus, blurs);
        Draft draft = drafted(plan.input, plan, focus, blurs, high);
        const WaveChoice& choice = sweep.wave(focus.powers.front(), high, draft.powers());
        if (choice.wave) {
            plan.waveform = *choice.wave;
            return draft;
        }
        // Rounded down, so that the next choice is not refused for the last digit.
        const Dioptre reach = Dioptre::fromSi(std::floor(choice.reachable.si() * 1e3) * 1e-3);
        const bool alphaAsks = plan.pS && high == *plan.pS + plan.alpha;
        if (alphaAsks && reach > *plan.pS && reach < high) {
            relax(reach, choice.why);
        } else {
            return fail(Fault::unsafe,
                        choice.why + (choice.reachable < high ? " " + whoAsksFor(plan, high, blurs, focus, choice)
                                                              : std::string()));
        }
    }
}

void warnOfWave(Plan& plan, const std::string& unshaped) {
    for (const Level& level : plan.levels) {
        if (!plan.sweeps() || level.rmsError <= level.budget * (1.0 + 1e-9)) continue;
        plan.warnings.push_back("Light for " + inWords(level.power) + " is off by " + inWords(level.rmsError) +
                                " rms, more than the " + inWords(level.budget) +
                                " allowed: the recorded wave reaches no nearer. A continuous or shaped wave would.");
    }
    const WaveMode asked = plan.input.rig.waves;
    if (!plan.sweeps() || asked == WaveMode::idealSine) return;
    if (!plan.input.lens) {
        plan.warnings.push_back(
            "The lens has no calibration: the plan is for an ideal sine, which no real lens follows. "
            "Record its waves, or choose ideal-sine to plan without.");
    } else if (!unshaped.empty()) {
        plan.warnings.push_back(unshaped + " A continuous wave is planned until then.");
    }
}

}  // namespace

bool Plan::operator==(const Plan& o) const {
    return input == o.input && waveform == o.waveform && farOffset == o.farOffset && pS == o.pS && alpha == o.alpha &&
           driver == o.driver && focusPower == o.focusPower && levels == o.levels && slots == o.slots &&
           regions == o.regions && warnings == o.warnings && light == o.light && unlearnt == o.unlearnt;
}

Result<Plan> plan(const PlanInput& input, const Plan* previous, std::vector<Dioptre>* unlearnt) {
    if (const auto good = checkedInput(input); !good) return tl::unexpected(good.error());
    Plan plan;
    plan.input = input;
    plan.alpha = input.alpha;
    plan.farOffset = farBorderOffset(input.eye).power;
    for (const PlanObject& object : input.objects) {
        RegionPlan region;
        region.id = object.id;
        region.name = object.name;
        region.look = object.look;
        region.nearest = object.nearest;
        region.farthest = object.farthest;
        region.sigma = object.sigma;
        plan.regions.push_back(std::move(region));
    }

    const FocusVerdict focus = focusVerdict(input, plan.regions);
    plan.focusPower = focus.powers[focus.main];
    std::vector<BlurWish> blurs(input.objects.size());
    for (std::size_t i = 0; i < blurs.size(); ++i) {
        if (input.objects[i].look == Look::blur) {
            blurs[i] = blurWish(input, input.objects[i], plan.focusPower, plan.regions[i]);
        }
    }
    findDriver(plan, blurs);

    SweepPlanner sweep(input, restOf(input), previous);
    auto draft = swept(focus, blurs, sweep, plan);
    if (unlearnt != nullptr) *unlearnt = sweep.unlearnt();
    if (!draft) return tl::unexpected(draft.error());
    if (const auto fits = fitted(*draft, sweep, plan); !fits) return tl::unexpected(fits.error());
    sortLevels(*draft);
    const Schedule& schedule = sweep.schedule(draft->wishes);
    plan.waveform = schedule.waveform;
    plan.levels = schedule.levels;
    plan.slots = schedule.slots;
    plan.light = schedule.light;
    plan.unlearnt = sweep.unlearnt();
    plan.work = sweep.work();
    ++plan.work.plans;
    plan.parts = sweep.parts();

    plan.focusPower = plan.levels.front().power;
    for (const Level& level : plan.levels) {
        if (level.kind == LevelKind::focus &&
            abs(level.power - plan.waveform.rest) < abs(plan.focusPower - plan.waveform.rest)) {
            plan.focusPower = level.power;
        }
    }
    describeRegions(plan, *draft);
    warnOfWave(plan, sweep.unshaped());
    return plan;
}

}  // namespace ilf
