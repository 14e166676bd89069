// What a plan means for people in the room: flicker, and what ambient light gives away. Predictions, with their models.
#pragma once

#include <string>
#include <vector>

#include "core/plan/plan.h"

namespace ilf {

enum class NoteTopic { flicker, ambient, privacy };
struct PlanNote {
    NoteTopic topic = NoteTopic::flicker;
    bool warns = false;
    std::string text;
    std::string model;  ///< what it rests on; nothing of it was measured in the room
    bool operator==(const PlanNote&) const = default;
};

/// Modulation of a level's light at `harmonic` times the sweep rate, as a share of its mean: at most 2 (one short flash
/// a sweep).
double modulationAt(const Plan& plan, std::size_t level, int harmonic);

/// Critical flicker fusion frequency of a round field `degrees` across (10, 30 or 50): ln(E / a) / b with E the
/// modulated retinal illuminance in trolands (Farrell 1987; coefficients from memory), the pupil by Watson and Yellott
/// for a lit field of 30 degrees.
/// `luminance` in cd/m^2, modulation as above.
Hertz flickerFusion(double luminance, double modulation, double degrees, double ageYears);

/// Illuminance of a lit region, lux: projector_lm / litArea_m2 times the plan's light.
double litIlluminance(const Plan& plan);

/// Detail that reading print of 3 mm at 0.5 m takes, the contrast such print has in plain light (assumed), and the most
/// contrast that still hides it (scheduling 6).
inline constexpr double kReadingDetail_cpd = 7.5, kPrintContrast = 0.59, kHidesPrint = 0.02;

/// What the eye looks at unless asked otherwise: the nearest focused object that can be seen sharp; none for a camera.
const RegionPlan* attendedRegion(const Plan& plan);

/// Contrast left of detail at 7.5 cycles per degree (3 mm print at 0.5 m) under projector and ambient light (scheduling
/// 6). Ambient light is seen through the whole sweep, the projector's through the level alone; both transfer functions
/// are those of a uniform defocus disc, absolute values. `original` 0.59 is assumed.
struct ContrastLeft {
    double dark = 0.0;     ///< without ambient light
    double ambient = 0.0;  ///< with Rig::room.ambient_lx
};
ContrastLeft contrastLeft(const Plan& plan, const RegionPlan& region);
/// The ambient light up to which the region keeps at most `contrast`, lux; 0 if it keeps more in the dark.
double ambientFor(const Plan& plan, const RegionPlan& region, double contrast);

std::vector<PlanNote> planNotes(const Plan& plan);

}  // namespace ilf
