#include <algorithm>

#include "app/headless/plan_command.h"
#include "app/words.h"
#include "core/base/as_text.h"
#include "core/perceived/prediction_words.h"
#include "core/plan/report.h"

namespace ilf::app {
namespace {

/// What a region is predicted to look like, and what its +- comes from.
std::string predictionText(const Plan& plan, const RegionPlan& region, const Document& document) {
    const RegionPrediction seen = predicted(plan, region, document);
    const Statement said = statement(plan, region, seen);
    std::string out;
    if (said.about != Saying::problem) out += "    predicted: " + said.text + "\n";
    if (!said.privacy.empty()) out += "    privacy: " + said.privacy + "\n";
    if (seen.blur_arcmin.error() <= 0.0) return out;
    out += "    \u00b1 " + asText("%.1f\u2032 of blur from", seen.blur_arcmin.error());
    for (std::size_t i = 0; i < kErrorSources; ++i) {
        const auto source = static_cast<ErrorSource>(i);
        if (seen.blur_arcmin.part(source) > 0.0)
            out += std::string(" ") + word(source) + asText(" %.1f\u2032,", seen.blur_arcmin.part(source));
    }
    out.back() = '\n';
    return out;
}

}  // namespace

std::string planText(const Plan& plan, const Document& document) {
    const PlanReport report = planReport(plan);
    std::string out;
    if (plan.sweeps()) {
        out += "Sweep " + asText("%.3f", plan.waveform.low.si()) + " to " + asText("%.3f D", plan.waveform.high.si()) +
               " at " + asText("%.4g Hz", plan.waveform.rate.si()) + " (" + std::string(word(plan.waveform.mode)) +
               " wave, " + std::string(word(plan.waveform.provenance)) + ")";
    } else {
        out += "No sweep: the lens stands still at " + asText("%.3f D", plan.waveform.low.si());
    }
    if (plan.pS) out += "; P_s " + asText("%.3f D", plan.pS->si()) + " + alpha " + asText("%.2f D", plan.alpha.si());
    for (const RegionPlan& region : plan.regions) {
        if (plan.driver && region.id == *plan.driver) out += ", driven by \"" + region.name + "\"";
    }
    out += ".\nEvery region gets " + asText("%.1f %%", 100.0 * plan.light) +
           " of steady light; the lens's power is off by ";
    double error = 0.0;
    for (const Level& level : plan.levels)
        error = std::max(error, level.rmsError.si());
    out += asText("%.3f D", error) + " rms at most while it is lit.\n" + report.why + "\n";
    for (const RegionPlan& region : plan.regions) {
        out += "  " + region.name + ": " + word(region.look) + " at " + asText("%.3f m", region.nearest.si());
        if (region.farthest > region.nearest) out += asText(" to %.3f m", region.farthest.si());
        if (region.sigma > 0.0_m) out += asText(" (known to +-%.3f m)", 2.0 * region.sigma.si());
        if (region.pMin) out += ", P_min " + asText("%.3f D", region.pMin->si());
        if (region.level) out += ", lit at " + asText("%.3f D", region.levelPower.si());
        if (region.look == Look::blur) {
            out += ", blur " + asText("%.1f", region.blurDiameter.in(1.0_um)) +
                   (region.blurDiameterFarthest > region.blurDiameter
                        ? asText(" to %.1f", region.blurDiameterFarthest.in(1.0_um))
                        : std::string()) +
                   " um relaxed, " + asText("%.1f um", region.blurDiameterAttending.in(1.0_um)) + " attending";
        }
        out += "\n";
        if (!region.problem.empty()) out += "    problem: " + region.problem + "\n";
        if (!region.help.empty()) out += "    help: " + region.help + "\n";
        out += predictionText(plan, region, document);
    }
    for (const std::string& warning : plan.warnings)
        out += "warning: " + warning + "\n";
    for (const PlanNote& note : report.notes)
        out += (note.warns ? "warning: " : "note: ") + note.text + " (" + note.model + ")\n";
    for (const std::string& help : report.help)
        out += "would help: " + help + "\n";
    if (!out.empty() && out.back() == '\n') out.pop_back();
    return out;
}

}  // namespace ilf::app
