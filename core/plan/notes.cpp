#include "core/plan/notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/optics/pupil.h"
#include "core/plan/words.h"

namespace ilf {
namespace {

constexpr double kWhite = 0.8;  // reflectance of what is lit, assumed
constexpr int kPhases = 64;

const char* const kFlickerModel = "Farrell 1987 (coefficients from memory) with the pupil of Watson and Yellott 2012; "
                                  "IEEE 1789-2015 limits from memory; not measured in this room";
const char* const kAmbientModel = "uniform defocus disc, 3 mm print at 0.5 m, contrast 0.59 assumed; not measured in "
                                  "this room";

std::string percent(double share) { return inWords(100.0 * share, share < 0.0995 ? 1 : 0) + " %"; }

/// |transfer| of a uniform disc `angle` across (radians).
double discTransfer(double angle) {
    const double x = std::numbers::pi * kReadingDetail_cpd * (180.0 / std::numbers::pi) * angle;
    return x < 1e-6 ? 1.0 : std::abs(2.0 * ::j1(x) / x);
}

/// Angle of the blur disc of a region through a power, radians.
double blurAngle(const Plan& plan, const RegionPlan& region, const RegionPlan* looking, Dioptre power) {
    const EyeOptics& eye = plan.input.eye;
    const Metre disc = looking != nullptr
                           ? blurDiameterAttending(eye, region.nearest, power, looking->nearest, looking->levelPower)
                           : blurDiameter(eye, region.nearest, power);
    return disc / eye.retina;
}

/// While the region's own level is lit.
double levelTransfer(const Plan& plan, const RegionPlan& region) {
    return discTransfer(blurAngle(plan, region, attendedRegion(plan), region.levelPower));
}

/// Mean over the sweep, for light that is always there.
double sweepTransfer(const Plan& plan, const RegionPlan& region) {
    const RegionPlan* looking = attendedRegion(plan);
    double sum = 0.0;
    for (const double power_D : samplesOf(plan.waveform.power, kPhases))
        sum += discTransfer(blurAngle(plan, region, looking, Dioptre::fromSi(power_D)));
    return sum / kPhases;
}

PlanNote flickerNote(const Plan& plan) {
    double modulation = 0.0;
    for (std::size_t l = 0; l < plan.levels.size(); ++l)
        modulation = std::max(modulation, modulationAt(plan, l, 1));
    const double rate = plan.waveform.rate.si(), luminance = litIlluminance(plan) * kWhite / std::numbers::pi;
    const auto fusion = [&](double field) { return flickerFusion(luminance, modulation, field, plan.input.ageYears); };
    const double limit = rate < 90.0 ? 0.025 * rate : std::min(100.0, 0.08 * rate);
    const double most = fusion(50.0).si();
    PlanNote note{NoteTopic::flicker, most > rate, {}, kFlickerModel};
    note.text =
        "Light comes in " + inWords(plan.waveform.rate) + " pulses with darkness between, where IEEE 1789 calls " +
        inWords(limit, 1) + " % of modulation low risk: warn photosensitive people. Predicted fusion at " +
        inWords(litIlluminance(plan), 0) + " lx is " + inWords(fusion(10.0).si(), 0) + ", " +
        inWords(fusion(30.0).si(), 0) + " and " + inWords(most, 0) + " Hz for fields of 10, 30 and 50 degrees: ";
    const std::string better = inWords(std::ceil(most / 10.0) * 10.0, 0) + " Hz";
    note.text += !note.warns ? "no flicker is expected."
                 : fusion(10.0).si() > rate
                     ? "flicker will be seen. Sweep at " + better + " or more, or dim the light."
                     : "flicker may be seen at the edge of the view. A sweep of " + better + " would hide it.";
    return note;
}

void addAmbientNotes(const Plan& plan, std::vector<PlanNote>& notes) {
    const RegionPlan *worst = nullptr, *sharpest = nullptr;
    double most = -1.0;
    for (const RegionPlan& region : plan.regions) {
        if (region.look == Look::focus && sharpest == nullptr) sharpest = &region;
        if (region.look != Look::blur) continue;
        const double left = contrastLeft(plan, region).ambient;
        if (left > most) {
            most = left;
            worst = &region;
        }
    }
    if (worst == nullptr) return;
    const double light = litIlluminance(plan), ambient = plan.input.rig.room.ambient_lx, ratio = ambient / light;
    PlanNote note{NoteTopic::ambient, ratio > 0.1, {}, kAmbientModel};
    note.text = "Ambient " + inWords(ambient, 0) + " lx against " + inWords(light, 0) +
                " lx in lit regions: print in " + inQuotes(worst->name) + " keeps " + percent(most) + " contrast";
    if (sharpest != nullptr)
        note.text += ", in " + inQuotes(sharpest->name) + " " + percent(contrastLeft(plan, *sharpest).ambient);
    note.text += ratio > 0.5 ? ". Blurred print can be read; darken the room."
                 : ratio > 0.1
                     ? ". Fine print is partly readable in blurred areas; darken the room or light a smaller area."
                     : ".";
    notes.push_back(std::move(note));

    PlanNote privacy{NoteTopic::privacy, most > kHidesPrint, {}, kAmbientModel};
    const double dark = contrastLeft(plan, *worst).dark;
    if (most <= kHidesPrint) {
        privacy.text = "Looking through the glasses at what is focused, at most " + percent(most) +
                       " of the contrast of 3 mm print is left in blurred "
                       "areas. People without glasses read all of it.";
    } else if (dark <= kHidesPrint) {
        privacy.text = "No privacy: " + percent(most) +
                       " of the contrast is left, and 2 % is the most that hides print. "
                       "It would hold up to " +
                       inWords(ambientFor(plan, *worst, kHidesPrint), 0) +
                       " lx of ambient light. People without glasses read all of it.";
    } else {
        privacy.text = "No privacy: " + inQuotes(worst->name) + " keeps " + percent(dark) +
                       " contrast even in a dark room. Give it more strength. People without glasses read all of it.";
    }
    notes.push_back(std::move(privacy));
}

}  // namespace

double modulationAt(const Plan& plan, std::size_t level, int harmonic) {
    std::complex<double> sum = 0.0;
    double all = 0.0;
    for (const Slot& slot : plan.slots) {
        for (const LevelLight& light : slot.lit) {
            if (static_cast<std::size_t>(light.level) != level) continue;
            const double turns = harmonic * (slot.middle() * plan.waveform.rate);
            const double half = std::numbers::pi * harmonic * (slot.duration * plan.waveform.rate);
            sum += light.weight * (std::sin(half) / half) * std::polar(1.0, -2.0 * std::numbers::pi * turns);
            all += light.weight;
        }
    }
    return all > 0.0 ? 2.0 * std::abs(sum) / all : 0.0;
}

Hertz flickerFusion(double luminance, double modulation, double degrees, double ageYears) {
    struct Field {
        double degrees, a, b;
    };
    constexpr std::array<Field, 3> kFields{{{10.0, 0.1276, 0.1424}, {30.0, 0.1919, 0.1201}, {50.0, 0.5076, 0.1004}}};
    const Field& field =
        *std::ranges::min_element(kFields, {}, [&](const Field& f) { return std::abs(f.degrees - degrees); });
    const auto pupil = pupilInLight({luminance, roundField_deg2(30.0), 2}, ageYears);
    if (!pupil) return {};
    const double area_mm2 = 0.25 * std::numbers::pi * std::pow(pupil->in(1.0_mm), 2);
    const double trolands = luminance * area_mm2 * modulation;
    return Hertz::fromSi(trolands > field.a ? std::log(trolands / field.a) / field.b : 0.0);
}

double litIlluminance(const Plan& plan) {
    const RoomLight& room = plan.input.rig.room;
    return room.projector_lm / room.litArea_m2 * plan.light;
}

const RegionPlan* attendedRegion(const Plan& plan) {
    const RegionPlan* nearest = nullptr;
    for (const RegionPlan& region : plan.regions) {
        if (region.look != Look::focus || !region.problem.empty()) continue;
        if (nearest == nullptr || region.nearest < nearest->nearest) nearest = &region;
    }
    return plan.input.camera ? nullptr : nearest;
}

ContrastLeft contrastLeft(const Plan& plan, const RegionPlan& region) {
    const double light = litIlluminance(plan), ambient = plan.input.rig.room.ambient_lx;
    const double level = kPrintContrast * levelTransfer(plan, region);
    if (ambient <= 0.0) return {level, level};
    const double sweep = kPrintContrast * sweepTransfer(plan, region);
    return {level, (light * level + ambient * sweep) / (light + ambient)};
}

double ambientFor(const Plan& plan, const RegionPlan& region, double contrast) {
    const double level = levelTransfer(plan, region), sweep = sweepTransfer(plan, region);
    const double keeps = contrast / kPrintContrast;
    if (level >= keeps || sweep <= keeps) return 0.0;
    return litIlluminance(plan) * (keeps - level) / (sweep - keeps);
}

std::vector<PlanNote> planNotes(const Plan& plan) {
    std::vector<PlanNote> notes;
    if (!plan.sweeps()) return notes;
    notes.push_back(flickerNote(plan));
    addAmbientNotes(plan, notes);
    return notes;
}

}  // namespace ilf
