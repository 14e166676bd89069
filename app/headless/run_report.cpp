#include "app/headless/run_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/headless/plan_command.h"
#include "core/base/as_text.h"
#include "ilf/version.h"

namespace ilf::app {
namespace {

using nlohmann::json;

json micro(Second time) { return std::round(1e3 * time.in(1.0_us)) / 1e3; }
json milli(Dioptre power) { return std::round(1e6 * power.si()) / 1e3; }

json deviceState(const devices::DeviceState& state) {
    return {{"content_hash_shown", std::to_string(state.hashShown)},
            {"light", state.light == devices::LightMode::slotted ? "slotted" : "steady"},
            {"swaps", state.swaps},
            {"refusals", state.refusals},
            {"lens_low_D", state.waveform.low.si()},
            {"lens_high_D", state.waveform.high.si()},
            {"lens_unsettled_D", state.lensError.si()},
            {"lens_off_its_wave_rms_D", state.offWave.si()},
            {"lens_temperature_C", state.lensTemperature_C},
            {"triggers_lost", state.triggersLost},
            {"rate_changes_under_slotted_light", state.rateChangesUnderSlottedLight}};
}

json coreStatus(const devices::Status& status) {
    return {{"content_hash_shown", std::to_string(status.contentHashPlayed)},
            {"light", status.light == devices::LightMode::slotted ? "slotted" : "steady"},
            {"swaps", status.swaps},
            {"projector", status.projectorLine},
            {"lenses", status.lensLine}};
}

json timingOf(const devices::StageTiming& timing) {
    return {{"locked", timing.locked},
            {"phase_us", micro(timing.phase)},
            {"jitter_us", micro(timing.jitter)},
            {"drift_ppm", timing.driftPpm},
            {"missed_triggers", timing.missedTriggers}};
}

json lensOf(const LensDeviation& lens, double temperature_C, double most_mA) {
    json slots = json::array();
    for (const auto& slot : lens.slots) {
        slots.push_back({{"predicted_D", slot.predicted.si()},
                         {"received_D", slot.received.si()},
                         {"off_mD", milli(slot.received - slot.predicted)}});
    }
    return {{"off_its_wave_rms_mD", milli(lens.rms)},
            {"off_its_wave_worst_mD", milli(lens.worst)},
            {"off_in_slots_rms_mD", milli(lens.rmsInSlots)},
            {"slots", std::move(slots)},
            {"temperature_C", temperature_C},
            {"greatest_current_mA", most_mA}};
}

const char* kProvenance = "drivers of real devices over emulated cables; never on hardware";

}  // namespace

Outcome outcomeOf(ReceivedSweep sweep, const Program& program, const Rig& rig) {
    Outcome outcome;
    outcome.light = devices::compared(intendedSlots(program, rig), receivedSlots(sweep));
    outcome.quantisation = quantisationOf(program, rig);
    const std::array<const std::vector<Dioptre>*, 2> powers{&sweep.received.left, &sweep.received.right};
    for (std::size_t eye = 0; eye < 2; ++eye) {
        if (!powers[eye]->empty())
            outcome.lenses[eye] = deviationOf(*powers[eye], sweep.received.sweep, program, outcome.light);
    }
    outcome.sweep = std::move(sweep);
    return outcome;
}

bool asIntended(const Outcome& outcome) {
    return outcome.light.same() && !outcome.sweep.received.harmed && outcome.sweep.received.ledCurrentWrites == 0;
}

std::string verdict(const Outcome& outcome) {
    std::string line = "Emulated rig: " + devices::verdict(outcome.light) + "; slots of " +
                       std::to_string(outcome.quantisation.bits) + (outcome.quantisation.bits == 1 ? " bit" : " bits") +
                       " leave " + asText("%.2f", 100.0 * outcome.quantisation.mean) + " % mean error; lenses " +
                       asText("%.0f", 1e3 * outcome.lenses[0].rms.si()) + " and " +
                       asText("%.0f", 1e3 * outcome.lenses[1].rms.si()) + " mD rms off their wave";
    if (outcome.sweep.received.harmed) line += "; SOMETHING WAS SENT THAT WOULD HURT A PROJECTOR";
    if (outcome.sweep.received.ledCurrentWrites > 0)
        line += "; LED CURRENTS WERE WRITTEN " + std::to_string(outcome.sweep.received.ledCurrentWrites) + " TIMES";
    return line + ". Emulated, never on hardware.";
}

std::string inWords(const Ended& ended) {
    const std::string light =
        ended.steadyWhite ? "The light is steady white"
                          : "The light is not steady white (" + asText("%.1f", 100.0 * ended.light) + " % of it)";
    if (ended.atRest) return light + " and the lenses rest.";
    return light + " and the lenses do not rest (up to " + asText("%.2f", ended.farthest.si()) + " D away).";
}

json runReport(const Prepared& project, const std::string& file, double seconds, const Played& played) {
    const CompileCounters& counters = project.compiled.counters;
    const char* real = "real devices; their light was not measured";
    const char* provenance = played.status.emulated    ? kProvenance
                             : played.status.simulated ? "simulated lens and projector"
                                                       : real;
    json shown = played.state && !played.status.emulated ? deviceState(*played.state) : coreStatus(played.status);
    shown["content_hash_sent"] = std::to_string(contentHash(project.compiled.program));
    shown["sweeps"] = played.sweeps;
    json report = {{"program", std::string("illuminatedfocus ") + kVersion},
                   {"file", file},
                   {"provenance", provenance},
                   {"rig", project.compiled.document.rig.name},
                   {"seconds", seconds},
                   {"plan", json::parse(planJson(project.compiled.plan, project.compiled.document))},
                   {"times_ms",
                    {{"open", project.open_ms},
                     {"plan", project.plan_ms},
                     {"compile", project.compile_ms},
                     {"sent_to_swapped", played.sentToSwapped_ms}}},
                   {"tiles",
                    {{"all", counters.tiles},
                     {"computed", counters.computed},
                     {"unchanged", counters.unchanged},
                     {"uniform", counters.uniform},
                     {"seam", counters.seamTiles}}},
                   {"played", std::move(shown)}};
    if (played.status.timing) report["timing"] = timingOf(*played.status.timing);
    return report;
}

void addOutcome(json& report, const Outcome& outcome) {
    const auto& received = outcome.sweep.received;
    json slots = json::array();
    for (std::size_t i = 0; i < outcome.light.slots.size(); ++i) {
        const auto& slot = outcome.light.slots[i];
        slots.push_back({{"slot", i},
                         {"differing_pixels", slot.differingPixels},
                         {"largest", slot.largest},
                         {"mean", slot.mean},
                         {"missing", slot.missing},
                         {"late_us", micro(slot.late)},
                         {"longer_us", micro(slot.longer)}});
    }
    report["received"] = std::move(slots);
    report["comparison"] = {{"differing_pixels", outcome.light.differingPixels},
                            {"missing_slots", outcome.light.missing},
                            {"extra_slots", outcome.light.extra},
                            {"offset_us", micro(outcome.light.offset)},
                            {"jitter_us", micro(outcome.light.jitter)},
                            {"as_intended", asIntended(outcome)},
                            {"verdict", verdict(outcome)}};
    const Quantisation& q = outcome.quantisation;
    report["quantisation"] = {{"bits", q.bits},       {"step", q.step},        {"largest_error", q.largest},
                              {"mean_error", q.mean}, {"mean_shift", q.shift}, {"unit", "share of full light"}};
    report["lenses"] = {{"left", lensOf(outcome.lenses[0], received.temperature_C[0], received.most_mA[0])},
                        {"right", lensOf(outcome.lenses[1], received.temperature_C[1], received.most_mA[1])}};
    report["cables"] = {{"sweep_ms", received.sweep.in(1.0_ms)},
                        {"frames", received.frames},
                        {"triggers", received.triggers},
                        {"usb_transfers", received.transfers},
                        {"patterns", received.patterns},
                        {"harmed", received.harmed},
                        {"led_current_writes", received.ledCurrentWrites},
                        {"log", received.log}};
}

void addMishap(json& report, const Mishap& mishap, const ReceivedSweep& sweep, const Ended& ended) {
    const auto& received = sweep.received;
    report["mishap"] = {{"fault", mishap.fault},
                        {"noticed_ms", mishap.noticed_ms},
                        {"ended",
                         {{"steady_white", ended.steadyWhite},
                          {"light", ended.light},
                          {"lenses_at_rest", ended.atRest},
                          {"lenses_farthest_from_rest_D", ended.farthest.si()},
                          {"patterns", received.patterns},
                          {"in_words", inWords(ended)}}},
                        {"harmed", received.harmed},
                        {"led_current_writes", received.ledCurrentWrites},
                        {"log", received.log}};
}

}  // namespace ilf::app
