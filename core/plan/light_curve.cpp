#include "core/plan/light_curve.h"

#include <algorithm>
#include <cmath>

#include "core/plan/schedule.h"
#include "core/plan/words.h"

namespace ilf {
namespace {

constexpr double kWorthSaying = 1.02;

const RegionPlan* driverOf(const Plan& plan) {
    const auto driver = std::ranges::find_if(plan.regions, [&](const RegionPlan& r) { return plan.driver == r.id; });
    return driver == plan.regions.end() ? nullptr : &*driver;
}

/// The levels as they were wished for.
std::vector<LevelWish> wishesOf(const Plan& plan) {
    std::vector<LevelWish> wishes;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        LevelWish wish{plan.levels[l].kind, plan.levels[l].power, std::nullopt};
        for (const RegionPlan& region : plan.regions) {
            if (wish.kind != LevelKind::blur || region.level != static_cast<int>(l) || !region.pMin) continue;
            if (*region.pMin >= wish.power) continue;  // cannot be blurred, and binds no one
            wish.above = std::max(wish.above.value_or(*region.pMin), *region.pMin);
        }
        wishes.push_back(wish);
    }
    return wishes;
}

/// The plan for another input, made beside this one.
std::optional<Plan> replanned(const PlanInput& input) {
    auto other = plan(input);
    return other ? std::optional(*std::move(other)) : std::nullopt;
}

std::string gain(const Plan& now, const Plan& then) {
    return "light grows by " + inWords(100.0 * (then.light / now.light - 1.0), 0) + " %";
}

bool worthSaying(const Plan& now, const std::optional<Plan>& then) {
    return then && now.light > 0.0 && then->light >= kWorthSaying * now.light;
}

/// Deep objects are told by their nearest point, which is what counts.
const char* nearestPoint(const RegionPlan& region) {
    return region.nearest == region.farthest ? "" : ", its nearest point,";
}

/// The driver moved to where the next region would drive, at most to twice its distance.
void addMovedDriver(const Plan& now, std::vector<std::string>& help) {
    const RegionPlan* driver = driverOf(now);
    if (driver == nullptr || !isFinite(driver->nearest)) return;
    Dioptre next = 0.5 / driver->nearest + now.farOffset;
    for (const RegionPlan& region : now.regions) {
        if (&region == driver || region.look != Look::blur || !region.pMin || region.alreadyBlurred) continue;
        next = std::max(next, *region.pMin);
    }
    if (next >= *now.pS - 0.01_D) return;
    PlanInput moved = now.input;
    const auto object = std::ranges::find(moved.objects, driver->id, &PlanObject::id);
    // To the millimetre, as it is said.
    const Metre to = Metre::fromSi(std::ceil((1.0 / (next - now.farOffset)).in(1.0_mm) - 1e-6) * 1e-3);
    object->farthest = object->farthest + (to - object->nearest);
    object->nearest = to;
    const auto then = replanned(moved);
    if (!worthSaying(now, then) || !then->pS) return;
    help.push_back("Move " + inQuotes(driver->name) + nearestPoint(*driver) + " from " + inWords(driver->nearest) +
                   " to " + inWords(to) + ": P_s falls from " + inWords(*now.pS) + " to " + inWords(*then->pS) + ", " +
                   gain(now, *then) + ".");
}

void addMoreError(const Plan& now, std::vector<std::string>& help) {
    PlanInput looser = now.input;
    looser.rig.powerBudget = 2.0 * looser.rig.powerBudget;
    const auto then = replanned(looser);
    if (!worthSaying(now, then)) return;
    help.push_back("Allow an error of " + inWords(looser.rig.powerBudget) + " instead of " +
                   inWords(now.input.rig.powerBudget) + ": " + gain(now, *then) + ".");
}

/// With little alpha few slots of a sine lie above P_min, whatever error is allowed.
void addMoreAlpha(const Plan& now, std::vector<std::string>& help) {
    if (!now.pS) return;
    PlanInput farther = now.input;
    farther.alpha = std::max(2.0 * farther.alpha, 0.2_D);
    const auto then = replanned(farther);
    if (!worthSaying(now, then) || then->alpha != farther.alpha) return;
    help.push_back("Raise alpha from " + inWords(now.input.alpha) + " to " + inWords(farther.alpha) + ": " +
                   gain(now, *then) + ".");
}

}  // namespace

std::vector<LightPoint> lightCurve(const Plan& plan, int points) {
    std::vector<LightPoint> curve;
    if (!plan.sweeps()) return curve;
    const std::vector<LevelWish> wishes = wishesOf(plan);
    Rig rig = plan.input.rig;
    for (int i = 0; i < points; ++i) {
        rig.powerBudget = Dioptre::fromSi(std::pow(10.0, -2.0 + 2.0 * i / std::max(1, points - 1)));
        const Schedule schedule = scheduled(plan.waveform, rig, wishes);
        LightPoint point{rig.powerBudget, schedule.light, {}};
        for (const Level& level : schedule.levels)
            point.rmsError = std::max(point.rmsError, level.rmsError);
        // What less error gave, more error gives too: the scheduler moves the wave for 2 % of gain only.
        if (!curve.empty() && curve.back().light > point.light) {
            point.light = curve.back().light;
            point.rmsError = curve.back().rmsError;
        }
        curve.push_back(point);
    }
    return curve;
}

std::vector<std::string> whatWouldHelp(const Plan& plan) {
    std::vector<std::string> help;
    if (!plan.sweeps()) return help;
    addMovedDriver(plan, help);
    addMoreError(plan, help);
    addMoreAlpha(plan, help);
    return help;
}

std::string whyThisSweep(const Plan& plan) {
    if (!plan.sweeps()) {
        const bool asked = std::ranges::any_of(
            plan.regions, [](const RegionPlan& r) { return r.look == Look::blur && !r.problem.empty(); });
        return asked ? "The lens stands still: what is to be blurred is out of its reach."
                     : "The lens stands still: nothing has to be blurred by a sweep.";
    }
    const std::string to = "The sweep goes to " + inWords(plan.waveform.high);
    const RegionPlan* driver = driverOf(plan);
    if (driver == nullptr) return to + " because that is where focused objects are sharp.";
    if (plan.waveform.high > *plan.pS + plan.alpha + 1e-6_D)
        return to + " because a strength or a focused object asks for it; " + inQuotes(driver->name) + " at " +
               inWords(driver->nearest) + " alone would need " + inWords(*plan.pS) + " + alpha.";
    return to + " because " + inQuotes(driver->name) + ", the nearest that can be blurred" +
           (driver->nearest == driver->farthest ? ", at " : ", its nearest point at ") + inWords(driver->nearest) +
           ", needs P_s = " + inWords(*plan.pS) + ", and alpha adds " + inWords(plan.alpha) + ".";
}

}  // namespace ilf
