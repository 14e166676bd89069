#include "core/perceived/prediction_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/plan/notes.h"
#include "core/plan/words.h"

namespace ilf {
namespace {

/// Letters are recognised when they are five times as high as the finest detail resolved (Snellen's optotypes).
constexpr double kDetailsOfLetter = 5.0;

/// Blur within the depth of field that eyes are found to have is not noticed, however little is allowed (optics 5).
constexpr Metre kDepthOfField = 20.0_um;

const char* const kBystanders = " People without glasses read all of it.";

/// Fewest decimals that show a step of `step`.
int decimalsFor(double step) { return step >= 2.0 ? 0 : step >= 0.2 ? 1 : 2; }

std::string percent(double share) { return inWords(100.0 * share, share < 0.0995 ? 1 : 0) + " %"; }

/// 20/x to two figures: more would be pretended.
std::string acuity(double x) {
    const double step = x >= 100.0 ? 10.0 : 5.0;
    return "20/" + inWords(std::max(20.0, step * std::round(x / step)), 0);
}

/// Print whose finest detail is kReadingDetail_cpd at that distance: 3 mm at 0.5 m.
std::string printAt(Metre distance) {
    if (!isFinite(distance) || distance > 100.0_m) return "print as large as 3 mm at 0.5 m";
    char text[64];
    std::snprintf(text, sizeof text, "%.2g mm print at %.3g m", 6.0 * distance.si(), distance.si());
    return text;
}

/// A sharp region keeps at least, a blurred one at most: one side of the +- is what matters.
std::string contrastIn(const RegionPrediction& seen) {
    const double error = seen.contrast.error(), value = seen.contrast.value;
    const bool most = seen.look == Look::blur;
    return printAt(seen.distance) + " keeps " +
           (most ? "at most " + percent(std::min(kPrintContrast, value + error))
                 : "at least " + percent(std::max(0.0, value - error))) +
           " contrast (sharp: " + percent(kPrintContrast) + ")";
}

std::string discs(const RegionPrediction& seen) {
    return plusMinus(seen.blur_arcmin.value, seen.blur_arcmin.error()) + "\u2032 (" + inWords(seen.defocus_D.value, 1) +
           " D)";
}

std::string blurredTo(const RegionPrediction& seen) {
    if (seen.camera) return "Blurred for the camera to about " + discs(seen) + ".";
    return "Blurred to about " + discs(seen) + ": like " + acuity(seen.snellen.value) + "; " + contrastIn(seen) + ".";
}

std::string whatIsAttended(const Plan& plan) {
    const RegionPlan* attended = attendedRegion(plan);
    return attended != nullptr ? "looks at " + inQuotes(attended->name) : "looks elsewhere";
}

/// Height of the smallest letters that may be read by who looks straight at it, the pupil as small as it may be.
std::string smallestLetters(const RegionPrediction& seen) {
    const Predicted& acuity = seen.snellenLooked;
    const double detail = std::max(1.0, (acuity.value - acuity.error()) / 20.0) * kArcmin;
    return inWords(std::max(1.0, std::round(1e3 * kDetailsOfLetter * detail * seen.distance.si())), 0) + " mm";
}

void addPrivacy(const Plan& plan, const RegionPrediction& seen, Statement& said) {
    const double aside = std::min(kPrintContrast, seen.contrast.value + seen.contrast.error()),
                 looked = std::min(kPrintContrast, seen.contrastLooked.value + seen.contrastLooked.error());
    const std::string print = printAt(seen.distance), most = percent(kHidesPrint);
    said.privacyWarns = seen.print != Legibility::hidden;
    switch (seen.print) {
    case Legibility::hidden:
        said.privacy = "To the wearer " + print + " stays unreadable, even looked at: at most " +
                       percent(std::max(aside, looked)) + " contrast, and " + most + " hides it. Letters of " +
                       smallestLetters(seen) + " and more may be made out.";
        break;
    case Legibility::hiddenAside:
        said.privacy = "To the wearer " + print + " stays unreadable only while the eye " + whatIsAttended(plan) +
                       " (at most " + percent(aside) + " contrast; " + most +
                       " hides it). Looked at, with the eye relaxed, it keeps up to " + percent(looked) +
                       " and may be read.";
        break;
    case Legibility::doubtful:
    case Legibility::readable:
        said.privacy = "No privacy: to the wearer " + print + " keeps up to " + percent(aside) +
                       " contrast while the eye " + whatIsAttended(plan) + ", up to " + percent(looked) +
                       " looked at, and " + most + " is the most that hides it.";
        break;
    case Legibility::visibleToCamera:
        said.privacyWarns = false;
        return;
    }
    said.privacy += kBystanders;
}

std::string brightness(const RegionPrediction& seen) { return " It has " + percent(seen.light) + " of steady light."; }

Statement focused(const Plan& plan, const RegionPrediction& seen) {
    const EyeOptics& eye = plan.input.eye;
    const Metre sharp = seen.camera ? eye.confusion : std::max(eye.confusion, kDepthOfField);
    const double acceptable = sharp / eye.retina / kArcmin;
    Statement said;
    if (seen.blur_arcmin.value + seen.blur_arcmin.error() > acceptable) {
        said = {Saying::soft, true,
                "May look soft: blurred to " + plusMinus(seen.blur_arcmin.value, seen.blur_arcmin.error()) +
                    "\u2032, and " + inWords(acceptable, 1) + "\u2032 still counts as sharp"};
    } else if (seen.seams && seen.seam.value + seen.seam.error() >= kSeamSeen) {
        said = {Saying::seam, true,
                "Sharp, but its border shows: up to " + plusMinusPercent(seen.seam) + " brighter or darker"};
    } else {
        said = {Saying::sharp, false,
                "Sharp: blurred by no more than " + inWords(seen.blur_arcmin.value + seen.blur_arcmin.error(), 1) +
                    "\u2032"};
    }
    said.text += seen.camera ? "." : "; " + contrastIn(seen) + ".";
    said.text += brightness(seen);
    return said;
}

Statement neutral(const RegionPrediction& seen) {
    Statement said{Saying::even, false, {}};
    if (seen.sharpShare > 0.995) {
        said.text = "Lit evenly and sharp in all of its light";
    } else if (seen.sharpShare < 0.005) {
        said.text = "Lit evenly, and in all of its light blurred, to " + discs(seen) + " at most";
    } else {
        said.text = "Lit evenly: sharp in " + percent(seen.sharpShare) + " of its light, under a haze blurred to " +
                    discs(seen) + " in the rest";
    }
    said.text += seen.camera ? "." : "; " + contrastIn(seen) + ".";
    said.text += brightness(seen);
    return said;
}

}  // namespace

std::string plusMinus(double value, double error) {
    const int decimals = decimalsFor(error > 0.0 ? error : std::abs(value) / 10.0);
    return inWords(value, decimals) + " \u00b1 " + inWords(error, decimals);
}

std::string plusMinusPercent(const Predicted& share) {
    return plusMinus(100.0 * share.value, 100.0 * share.error()) + " %";
}

Statement statement(const Plan& plan, const RegionPlan& region, const RegionPrediction& seen) {
    Statement said;
    if (!region.problem.empty()) {
        said = {Saying::problem, true, region.problem, region.help};
    } else if (region.look == Look::blur && seen.print == Legibility::readable) {
        said = {Saying::readable, true, "Print in it can be read. " + blurredTo(seen)};
    } else if (region.look == Look::blur) {
        said = {Saying::blurred, false, blurredTo(seen)};
    } else if (!plan.sweeps() && region.look == Look::neutral) {
        said = {Saying::steady, false, "Steady light: nothing is blurred for anybody."};
    } else {
        said = region.look == Look::focus ? focused(plan, seen) : neutral(seen);
    }
    if (region.look == Look::blur) addPrivacy(plan, seen, said);
    return said;
}

}  // namespace ilf
