#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/headless/plan_command.h"
#include "app/words.h"
#include "core/perceived/prediction_words.h"
#include "core/plan/report.h"

namespace ilf::app {
namespace {

using nlohmann::json;

/// JSON has no infinity: an unreachable or absent number is null.
json number(double value) { return std::isfinite(value) ? json(value) : json(); }

template <class Q>
json optionalNumber(const std::optional<Q>& value) {
    return value ? number(value->si()) : json();
}

/// Where a region's distance comes from: "constant", "plane", "depth-map"; null where only objects are planned.
json distanceFrom(const Document& document, const RegionId& id) {
    const std::array<const char*, 3> kinds{"constant", "plane", "depth-map"};
    const Region* region = findRegion(document, id);
    return region != nullptr ? json(kinds[region->distance.index()]) : json();
}

const std::array<const char*, 3> kTopics{"flicker", "ambient", "privacy"};

/// Cosine and sine parts, from the mean up: f(t) = sum of cosine[k] cos(2 pi k rate t) + sine[k] sin(2 pi k rate t).
json harmonics(const Harmonics& f) {
    json cosine = json::array(), sine = json::array();
    for (const auto& c : f.c) {
        cosine.push_back(c.real());
        sine.push_back(-c.imag());
    }
    return {{"cosine", cosine}, {"sine", sine}};
}

json waveform(const Plan& plan) {
    const Waveform& wave = plan.waveform;
    const Extremes reach = extremes(wave.power);
    json out = {{"mode", plan.sweeps() ? std::string(word(wave.mode)) : "still"},
                {"provenance", word(wave.provenance)},
                {"lens", plan.input.lens ? json(plan.input.lens->lens) : json()},
                {"wave_id", wave.wave != 0 ? json(wave.wave) : json()},
                {"power_D", harmonics(wave.power)},
                {"predicted_D", {reach.low, reach.high}},
                {"lens_limits_D", {plan.input.rig.lensMin.si(), plan.input.rig.lensMax.si()}}};
    if (wave.drive.c.empty()) return out;
    const Extremes drive = extremes(wave.drive);
    out["drive"] = harmonics(wave.drive);
    out["drive_unit"] = word(wave.unit);
    out["drive_peak"] = std::max(std::abs(drive.low), std::abs(drive.high));
    out["drive_rms"] = wave.drive.rms();
    if (plan.input.lens) {
        out["drive_limits"] = {{"peak", plan.input.lens->limits.peak}, {"rms", plan.input.lens->limits.rms}};
        out["temperature_C"] = std::round(100.0 * plan.input.lens->temperature_C) / 100.0;
    }
    return out;
}

json predictedNumber(const Predicted& value) {
    json from = json::object();
    for (std::size_t i = 0; i < kErrorSources; ++i)
        from[word(static_cast<ErrorSource>(i))] = number(value.from[i]);
    return {{"value", number(value.value)}, {"plus_minus", number(value.error())}, {"from", from}};
}

const std::array<const char*, 8> kSayings{"problem", "readable", "blurred", "soft", "seam", "sharp", "even", "steady"};
const std::array<const char*, 5> kLegibilities{"unreadable", "unreadable_looking_elsewhere", "doubtful", "readable",
                                               "not_judged"};

json prediction(const Plan& plan, const RegionPlan& region, const Document& document) {
    const RegionPrediction seen = predicted(plan, region, document);
    const Statement said = statement(plan, region, seen);
    json out = {{"provenance", "predicted"},
                {"about", kSayings[static_cast<std::size_t>(said.about)]},
                {"statement", said.text},
                {"warns", said.warns},
                {"at_m", number(seen.distance.si())},
                {"blur_arcmin", predictedNumber(seen.blur_arcmin)},
                {"defocus_D", predictedNumber(seen.defocus_D)},
                {"contrast", predictedNumber(seen.contrast)},
                {"contrast_from_ambient", predictedNumber(seen.ambientLeak)},
                {"seam_contrast", seen.seams ? predictedNumber(seen.seam) : json()},
                {"light_share", number(seen.light)},
                {"sharp_share_of_light", number(seen.sharpShare)}};
    if (!seen.camera) out["acuity_20_over"] = predictedNumber(seen.snellen);
    if (said.privacy.empty()) return out;
    out["print"] = kLegibilities[static_cast<std::size_t>(seen.print)];
    out["contrast_looked_at"] = predictedNumber(seen.contrastLooked);
    out["privacy"] = said.privacy;
    return out;
}

}  // namespace

std::string planJson(const Plan& plan, const Document& document) {
    json regions = json::array();
    for (const RegionPlan& region : plan.regions) {
        regions.push_back({
            {"id", region.id},
            {"name", region.name},
            {"look", word(region.look)},
            {"distance_m", number(region.nearest.si())},
            {"farthest_m", number(region.farthest.si())},
            {"distance_sigma_m", region.sigma > 0.0_m ? number(region.sigma.si()) : json()},
            {"distance_from", distanceFrom(document, region.id)},
            {"P_min_D", optionalNumber(region.pMin)},
            {"level_D", region.level ? number(region.levelPower.si()) : json()},
            {"blur_diameter_um", number(region.blurDiameter.in(1.0_um))},
            {"blur_diameter_farthest_um", number(region.blurDiameterFarthest.in(1.0_um))},
            {"blur_diameter_attending_um", number(region.blurDiameterAttending.in(1.0_um))},
            {"scale", number(region.scale)},
            {"already_blurred", region.alreadyBlurred},
            {"problem", region.problem.empty() ? json() : json(region.problem)},
            {"help", region.help.empty() ? json() : json(region.help)},
            {"prediction", prediction(plan, region, document)},
        });
    }
    json slots = json::array();
    for (const Slot& slot : plan.slots) {
        json levels = json::array();
        for (const LevelLight& light : slot.lit) {
            levels.push_back(
                {{"level_D", plan.levels[static_cast<std::size_t>(light.level)].power.si()}, {"weight", light.weight}});
        }
        const auto level = slot.level();
        slots.push_back({
            {"index", slot.index},
            {"start_s", slot.start.si()},
            {"duration_s", slot.duration.si()},
            {"scene_time_s", slot.middle().si()},
            {"level_D", level ? json(plan.levels[static_cast<std::size_t>(*level)].power.si()) : json()},
            {"levels", levels},
            {"power_D", number(slot.power.si())},
            {"power_rms_error_D", level ? json(slot.rmsError.si()) : json()},
            {"duty", level ? slot.duration * plan.waveform.rate : 0.0},
            {"luminance", slot.luminance(plan.waveform.rate)},
        });
    }
    json levels = json::array();
    for (const Level& level : plan.levels) {
        levels.push_back({{"kind", level.kind == LevelKind::focus ? "focus" : "blur"},
                          {"power_D", level.power.si()},
                          {"slots", level.slots},
                          {"exposure_slots", level.exposure},
                          {"power_rms_error_D", level.rmsError.si()},
                          {"power_rms_budget_D", level.budget.si()}});
    }
    const PlanReport report = planReport(plan);
    json curve = json::array();
    for (const LightPoint& point : report.curve)
        curve.push_back({{"budget_D", point.budget.si()},
                         {"light_share", point.light},
                         {"power_rms_error_D", point.rmsError.si()}});
    json notes = json::array();
    for (const PlanNote& note : report.notes)
        notes.push_back({{"topic", kTopics[static_cast<std::size_t>(note.topic)]},
                         {"warns", note.warns},
                         {"text", note.text},
                         {"model", note.model}});
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
        {"waveform", waveform(plan)},
        {"levels", levels},
        {"regions", regions},
        {"slots", slots},
        {"warnings", plan.warnings},
        {"notes", notes},
        {"why", report.why},
        {"what_would_help", report.help},
        {"light_curve", curve},
    };
    return all.dump(2);
}

}  // namespace ilf::app
