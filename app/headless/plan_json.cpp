#include <nlohmann/json.hpp>

#include "app/headless/plan_command.h"
#include "app/words.h"

namespace ilf::app {
namespace {

using nlohmann::json;

/// JSON has no infinity: an unreachable or absent number is null.
json number(double value) { return std::isfinite(value) ? json(value) : json(); }

template <class Q>
json optionalNumber(const std::optional<Q>& value) {
    return value ? number(value->si()) : json();
}

}  // namespace

std::string planJson(const Plan& plan) {
    json regions = json::array();
    for (const RegionPlan& region : plan.regions) {
        regions.push_back({
            {"id", region.id},
            {"name", region.name},
            {"look", word(region.look)},
            {"distance_m", number(region.nearest.si())},
            {"farthest_m", number(region.farthest.si())},
            {"P_min_D", optionalNumber(region.pMin)},
            {"level_D", region.level ? number(region.levelPower.si()) : json()},
            {"blur_diameter_um", number(region.blurDiameter.in(1.0_um))},
            {"blur_diameter_attending_um", number(region.blurDiameterAttending.in(1.0_um))},
            {"scale", number(region.scale)},
            {"already_blurred", region.alreadyBlurred},
            {"problem", region.problem.empty() ? json() : json(region.problem)},
            {"help", region.help.empty() ? json() : json(region.help)},
        });
    }
    json slots = json::array();
    for (const Slot& slot : plan.slots) {
        slots.push_back({
            {"index", slot.index},
            {"start_s", slot.start.si()},
            {"duration_s", slot.duration.si()},
            {"level_D", slot.level ? json(plan.levels[static_cast<std::size_t>(*slot.level)].power.si()) : json()},
            {"power_D", number(slot.power.si())},
        });
    }
    json levels = json::array();
    for (const Level& level : plan.levels) {
        levels.push_back({{"kind", level.kind == LevelKind::focus ? "focus" : "blur"},
                          {"power_D", level.power.si()},
                          {"slots", level.slots},
                          {"weight", level.weight},
                          {"power_rms_error_D", level.rmsError.si()}});
    }
    json driver;
    if (plan.driver) {
        for (const RegionPlan& region : plan.regions) {
            if (region.id == *plan.driver) driver = region.name;
        }
    }
    const json all = {
        {"P_s_D", optionalNumber(plan.pS)},
        {"alpha_D", plan.alpha.si()},
        {"sweep_D", {plan.waveform.low.si(), plan.waveform.high.si()}},
        {"sweep_Hz", plan.waveform.rate.si()},
        {"rest_D", plan.waveform.rest.si()},
        {"driving_region", driver},
        {"K_f_D", plan.farOffset.si()},
        {"focus_D", plan.focusPower.si()},
        {"light_share", plan.light},
        {"observer", plan.input.camera ? "camera" : "eye"},
        {"waveform", {{"mode", plan.sweeps() ? "ideal-sine" : "still"}, {"provenance", "simulated"}}},
        {"levels", levels},
        {"regions", regions},
        {"slots", slots},
        {"warnings", plan.warnings},
    };
    return all.dump(2);
}

}  // namespace ilf::app
