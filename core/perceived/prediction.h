// What a wearer will see of each region, in figures: one prediction with one +- for each, and where the +- comes from.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf {

/// What may be wrong with what a prediction starts from.
enum class ErrorSource {
    distance,      ///< tolerances of the region's distance and of what the eye is accommodated to
    pupil,         ///< of this wearer in this light, against the one typed
    registration,  ///< where light of one level falls on the surface, against light of another
    model,         ///< the lens's power against its level's, and real eyes against the reduced one
};
inline constexpr std::size_t kErrorSources = 4;
const char* word(ErrorSource source);

/// How wrong each of them may be. The four are independent, so that what they do adds up as the root of their squares;
/// no probability is claimed for any.
struct PredictionErrors {
    Metre pupil = 1.0_mm;  ///< a single person against the formula (Watson and Yellott); none for a camera
    /// On the surface. Absent: the residual of the rig's registration there (`knownRegistration`), and where none is
    /// known what `SeamErrors` assumes.
    std::optional<Metre> registration;
    std::optional<Metre> distance;  ///< absent: the tolerance each region was given
    /// Absent: the rms error of the level's power, and `realEyeError`.
    std::optional<Dioptre> power;
    bool operator==(const PredictionErrors&) const = default;
};

/// How far an eye's defocus lies from the reduced eye's, for the myopic side, by its pupil: rays through the Navarro
/// eye, 0.021 D at 2 mm to 0.534 D at 8 mm (optics 4.2), in between linear.
Dioptre realEyeError(Metre pupil);

/// A predicted value, with what each source of error can do to it: the larger of its two directions, the others being
/// as assumed.
struct Predicted {
    double value = 0.0;
    std::array<double, kErrorSources> from{};

    double part(ErrorSource source) const { return from[static_cast<std::size_t>(source)]; }
    double error() const;                    ///< the +-: root of the sum of their squares
    double share(ErrorSource source) const;  ///< of the squares, 0..1; they add up to 1, or are all 0
    bool operator==(const Predicted&) const = default;
};

/// Whether print that a sharp eye reads at 0.5 m when it is 3 mm high, here of the same angle, can be read.
enum class Legibility {
    hidden,          ///< not even looked at, with the eye doing what it can: at most `kHidesPrint`, +- included
    hiddenAside,     ///< not while the wearer looks at what is focused
    doubtful,        ///< perhaps, even then
    readable,        ///< more than `kReadsPrint` is left even then
    visibleToCamera  ///< a camera stands in for the wearer: not judged
};
/// From here on privacy is out of the question (scheduling 6); between kHidesPrint and this it is not guaranteed.
inline constexpr double kReadsPrint = 0.05;

/// Predictions for one region at the point of it that shows its look least: the nearest one of a blurred region, of a
/// sharp one the more blurred of its ends. The eye of a blurred region attends the nearest focused object; that of
/// any other looks at the region itself.
struct RegionPrediction {
    RegionId id;
    Look look = Look::focus;
    Metre distance;            ///< of that point
    bool camera = false;       ///< observer is one: no acuity, no print
    Predicted blur_arcmin;     ///< diameter of the blur disc, D_e |E|; a neutral region's is its most blurred light
    Predicted defocus_D;       ///< |E|
    Predicted snellen;         ///< x of 20/x, see `snellenOf`
    Predicted contrast;        ///< `contrastLeft` with the room's ambient light, 0..kPrintContrast
    Predicted contrastLooked;  ///< the same for an eye that looks at the region and does all it can to read it
    Predicted snellenLooked;   ///< and its acuity
    Predicted ambientLeak;     ///< what ambient light adds to the contrast left, negative where it takes away
    Predicted seam;            ///< largest |I - 1| across its border with light of another level, see `seamOf`
    Metre registration;        ///< what its seam's part of registration was worked out with, on the surface
    bool seams = false;        ///< `seam` is predicted: light is displaced, and blended in closed form or not at all
    double light = 1.0;        ///< of steady light
    double sharpShare = 1.0;   ///< of its light that falls while the lens shows it sharp: 1, 0 or, neutral, in between
    Legibility print = Legibility::readable;
    bool operator==(const RegionPrediction&) const = default;
};

/// Judged by its contrasts, each with its +-.
Legibility legibility(const RegionPrediction& seen);

/// Snellen acuity of an eye behind a blur disc of `blur` radians: 20/x with
///
///     x = 20 sqrt(1 + (0.65 D_e |E|)^2),   D_e in mm, so that 0.65 D_e |E| = 650 blur
///
/// An estimate. The slope, 0.65 arcmin of resolution for each millimetre and dioptre, is Smith's (1991; from memory);
/// that a sharp eye resolves 1 arcmin and the two add as squares is assumed here. Real people differ by a factor of
/// 1.5: 1.8 D is found to give 20/200 (optics 5), here it gives 20/96 through 4 mm.
double snellenOf(double blur);

/// Largest |I - 1| across a straight border blended over `width`, where light of the blur disc `meant` (its radius on
/// the surface) is seen with the radius `seen` and `shift` away from where it was meant:
///
///     I(x) = 1 - S(meant, x) + S(seen, x + shift),   S(R, .) = a ramp of `width`, blurred by a disc of radius R
///
/// For small shifts and width >= 2 R that is shift / width; no blending could leave less than shift / (width + 2 R)
/// (scheduling 4.3). A disc of another size alone leaves 0.212 |seen - meant| / width.
double seamOf(Metre width, Metre meant, Metre seen, Metre shift);

/// Precondition: `region` is one of `plan`'s and the plan is of `document` (of an empty one where only objects are
/// planned: then distances have no tolerance). Derived, never measured. By what is contributed:
///
/// - distance: the region's tolerance, and, blurred, that of what is attended;
/// - pupil: blur grows with it, defocus does not;
/// - registration: seams only;
/// - model: the power of the region's level and of the attended one, within their rms errors, and real eyes.
///
/// Each is followed through the closed forms of core/optics to both ends of its range and to points in between, since
/// contrast comes back behind its zeros.
///
/// Seams: the painted border is blended for an eye in the middle of the two lens axes; each eye is half their distance
/// off, which shifts what it sees by (s - 1) times that. No blending leaves (s - 1) times the way to the optical
/// centre, taken at the region's farthest corner. The paper's ramps are as wide as the seam they hide, which differs
/// all along a border: not predicted. Where one surface stands before another nothing is blended; not predicted either.
RegionPrediction predicted(const Plan& plan, const RegionPlan& region, const Document& document,
                           const PredictionErrors& errors = {});

}  // namespace ilf
